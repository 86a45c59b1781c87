#include "reference/analytic_shape.h"

#include <glm/gtc/matrix_transform.hpp>

namespace tachylite::reference {
namespace {

double azimuth(double x, double y) {
  const double phi = std::atan2(y, x);
  return phi < 0 ? phi + 2 * kPi : phi;
}

/// Roots of a t^2 + 2 b t + c = 0 in ascending order, without cancellation.
std::optional<dvec2> solve_quadratic(double a, double b, double c, double discriminant) {
  if (!(discriminant >= 0) || a == 0) return std::nullopt;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  const double t0 = q / a, t1 = q != 0 ? c / q : 0;
  return dvec2(std::min(t0, t1), std::max(t0, t1));
}

}  // namespace

dmat4 unit_shape_to_world(const Shape& shape) {
  if (const auto* sphere = std::get_if<SphereShape>(&shape.kind)) {
    return shape.to_world * glm::scale(glm::translate(dmat4(1), sphere->center), dvec3(sphere->radius));
  }
  if (const auto* cylinder = std::get_if<CylinderShape>(&shape.kind)) {
    const dvec3 axis = cylinder->p1 - cylinder->p0;
    const double length = glm::length(axis);
    const Frame frame = frame_around(axis / length);
    const dmat4 to_axis(dvec4(frame.s * cylinder->radius, 0), dvec4(frame.t * cylinder->radius, 0),
                        dvec4(frame.n * length, 0), dvec4(cylinder->p0, 1));
    return shape.to_world * to_axis;
  }
  return shape.to_world;
}

std::optional<AnalyticHit> intersect_unit_shape(const Shape& shape, const dvec3& o, const dvec3& d,
                                                double t_max) {
  const bool rectangle = std::holds_alternative<RectangleShape>(shape.kind);
  if (rectangle || std::holds_alternative<DiskShape>(shape.kind)) {
    const double t = -o.z / d.z;
    if (!(t > 0 && t < t_max)) return std::nullopt;
    const dvec3 p(o.x + t * d.x, o.y + t * d.y, 0);
    const bool inside = rectangle ? std::abs(p.x) <= 1 && std::abs(p.y) <= 1 : p.x * p.x + p.y * p.y <= 1;
    if (!inside) return std::nullopt;
    return AnalyticHit{t, p};
  }
  const bool sphere = std::holds_alternative<SphereShape>(shape.kind);
  const dvec3 only(1, 1, sphere ? 1 : 0);  // a cylinder is a circle in x and y
  const dvec3 oo = o * only, dd = d * only;
  const double a = glm::dot(dd, dd), b = glm::dot(oo, dd), c = glm::dot(oo, oo) - 1;
  // Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection": b^2 - a c from the nearest
  // point.
  const dvec3 nearest = oo - dd * (b / a);
  const auto roots = solve_quadratic(a, b, c, a * (1 - glm::dot(nearest, nearest)));
  if (!roots) return std::nullopt;
  for (const double t : {roots->x, roots->y}) {
    if (!(t > 0 && t < t_max)) continue;
    dvec3 p = o + t * d;
    const double radius = glm::length(p * only);
    p = {p.x / radius, p.y / radius, sphere ? p.z / radius : p.z};
    if (!sphere && !(p.z >= 0 && p.z <= 1)) continue;
    return AnalyticHit{t, p};
  }
  return std::nullopt;
}

UnitShapePoint unit_shape_point(const Shape& shape, const dvec3& p) {
  if (std::holds_alternative<RectangleShape>(shape.kind)) {
    return {{0, 0, 1}, {0.5 * (p.x + 1), 0.5 * (p.y + 1)}, {2, 0, 0}, {0, 2, 0}};
  }
  const double phi = azimuth(p.x, p.y), r = std::hypot(p.x, p.y);
  const dvec2 e = r > 0 ? dvec2(p.x, p.y) / r : dvec2(1, 0);  // (cos phi, sin phi)
  if (std::holds_alternative<DiskShape>(shape.kind)) {
    return {{0, 0, 1},
            {r, phi / (2 * kPi)},
            {e, 0},
            {-e.y, e.x, 0}};  // dp_dv as Mitsuba has it: not scaled by 2 pi r
  }
  if (std::holds_alternative<SphereShape>(shape.kind)) {
    const double theta = std::atan2(r, p.z);
    return {p, {phi / (2 * kPi), theta / kPi}, 2 * kPi * dvec3(-p.y, p.x, 0), kPi * dvec3(p.z * e, -r)};
  }
  return {{e, 0}, {phi / (2 * kPi), p.z}, 2 * kPi * dvec3(-e.y, e.x, 0), {0, 0, 1}};
}

dvec3 sample_unit_shape(const Shape& shape, const dvec2& u) {
  if (std::holds_alternative<RectangleShape>(shape.kind)) return {2 * u.x - 1, 2 * u.y - 1, 0};
  if (std::holds_alternative<DiskShape>(shape.kind)) return {sample_disk(u), 0};
  if (std::holds_alternative<SphereShape>(shape.kind)) return sample_sphere(u);
  return {std::cos(2 * kPi * u.x), std::sin(2 * kPi * u.x), u.y};
}

double unit_shape_area(const Shape& shape, const dmat4& to_world) {
  const dvec3 x(to_world[0]), y(to_world[1]), z(to_world[2]);
  if (std::holds_alternative<RectangleShape>(shape.kind)) return 4 * glm::length(glm::cross(x, y));
  if (std::holds_alternative<DiskShape>(shape.kind)) return kPi * glm::length(glm::cross(x, y));
  if (std::holds_alternative<SphereShape>(shape.kind)) return 4 * kPi * glm::dot(x, x);
  return 2 * kPi * glm::length(x) * glm::length(z);
}

std::shared_ptr<const Mesh> make_cube_mesh() {
  static const std::shared_ptr<const Mesh> cube = [] {
    auto mesh = std::make_shared<Mesh>();
    // Corners of each face in the order of uv = (0,1), (1,1), (1,0), (0,0).
    const glm::vec3 corners[6][4] = {{{1, -1, -1}, {1, -1, 1}, {-1, -1, 1}, {-1, -1, -1}},
                                     {{1, 1, -1}, {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}},
                                     {{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}},
                                     {{1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}},
                                     {{-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, -1}},
                                     {{1, 1, -1}, {1, -1, -1}, {-1, -1, -1}, {-1, 1, -1}}};
    const glm::vec2 uvs[4] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    for (uint32_t face = 0; face < 6; ++face) {
      for (int k = 0; k < 4; ++k) {
        mesh->positions.push_back(corners[face][k]);
        mesh->uvs.push_back(uvs[k]);
      }
      mesh->triangles.push_back({4 * face, 4 * face + 1, 4 * face + 2});
      mesh->triangles.push_back({4 * face + 3, 4 * face, 4 * face + 2});
    }
    return mesh;
  }();
  return cube;
}

}  // namespace tachylite::reference
