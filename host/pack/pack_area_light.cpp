#include "pack/pack_area_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/pi.h"
#include "pack/float_bits.h"
#include "pack/pack_texture.h"
#include "shared/bvh.h"
#include "shared/geometry.h"
#include "shared/light.h"
#include "shared/material.h"

namespace tachylite {
namespace {

/// One corner of a triangle, in device space.
struct Corner {
  dvec3 p, n;  // n: vertex normal, 0 when there is none
  dvec2 uv;
};
using Triangle = std::array<Corner, 3>;

Triangle load_triangle(const Geometry& geometry, const ShapeGeometry& range, uint32_t primitive) {
  Triangle t;
  const glm::uvec3 v = geometry.triangles[primitive];
  for (int k = 0; k < 3; ++k) {
    Corner& corner = t[static_cast<size_t>(k)];
    corner.p = dvec3(geometry.vertices[v[k]]);
    corner.n = range.has_normals ? dvec3(geometry.normals[v[k]]) : dvec3(0);
    // Without uvs the barycentrics (b1, b2) serve.
    corner.uv = range.has_uv ? dvec2(geometry.uvs[v[k]]) : dvec2(k == 1 ? 1 : 0, k == 2 ? 1 : 0);
  }
  return t;
}

dvec3 area_vector(const Triangle& t) { return 0.5 * glm::cross(t[1].p - t[0].p, t[2].p - t[0].p); }

/// The triangle turned so that the corner which `other` does not share comes first; nothing unless exactly two are
/// shared.
std::optional<Triangle> turned_from(const Triangle& t, const Triangle& other) {
  int lonely = -1, count = 0;
  for (int k = 0; k < 3; ++k) {
    const dvec3& p = t[static_cast<size_t>(k)].p;
    if (std::none_of(other.begin(), other.end(), [&](const Corner& c) { return c.p == p; })) lonely = k, ++count;
  }
  if (count != 1) return std::nullopt;
  return Triangle{t[static_cast<size_t>(lonely)], t[static_cast<size_t>((lonely + 1) % 3)],
                  t[static_cast<size_t>((lonely + 2) % 3)]};
}

/// The first of two triangles, turned so that its corner 0 is the right angle of the rectangle which both form; uv
/// and normals must continue over the diagonal (`with_uv`).
std::optional<Triangle> as_rectangle(const Triangle& a, const Triangle& b, bool with_uv) {
  const auto t = turned_from(a, b), opposite = turned_from(b, a);
  if (!t || !opposite) return std::nullopt;
  const dvec3 e1 = (*t)[1].p - (*t)[0].p, e2 = (*t)[2].p - (*t)[0].p;
  const double size = glm::length(e1) + glm::length(e2);
  double far = 0;
  for (const Corner& c : *t) far = std::max(far, std::max({std::abs(c.p.x), std::abs(c.p.y), std::abs(c.p.z)}));
  const double rounding = 4 * std::numeric_limits<float>::epsilon() * far;
  if (rounding > 1e-4 * size) return std::nullopt;
  if (glm::length((*t)[1].p + e2 - (*opposite)[0].p) > rounding + 1e-6 * size) return std::nullopt;
  if (std::abs(glm::dot(e1, e2)) > 1e-5 * glm::length(e1) * glm::length(e2) + rounding * size) return std::nullopt;
  if (!(glm::dot(area_vector(a), area_vector(b)) > 0)) return std::nullopt;
  const dvec2 uv = (*t)[1].uv + (*t)[2].uv - (*t)[0].uv;
  if (with_uv && glm::length(uv - (*opposite)[0].uv) > 1e-5 * (1 + glm::length(uv))) return std::nullopt;
  return t;
}

/// Whether the vertex normals bend the triangle's own: 0 flat, 1 flat but turned to the other side, 2 smooth.
int bend(const Triangle& t, const dvec3& n) {
  int front = 0, back = 0;
  for (const Corner& c : t) {
    if (glm::dot(c.n, c.n) < 1e-12) return 0;  // the geometric normal serves
    const double cosine = glm::dot(glm::normalize(c.n), n);
    front += cosine > 1 - 1e-9;
    back += cosine < -1 + 1e-9;
  }
  return front == 3 ? 0 : (back == 3 ? 1 : 2);
}

struct FlatContext {
  const Scene& scene;
  const LightRadiance& radiance;
  bool flip;
  double density;  // of meshes with normals: that Mitsuba samples points with, its choice of the mesh included [1/area]
};

double mesh_area(const Geometry& geometry, const ShapeGeometry& range) {
  double area = 0;
  for (uint32_t i = 0; i < range.primitive_count; ++i)
    area += glm::length(area_vector(load_triangle(geometry, range, range.first_primitive + i)));
  return area;
}

LightRecord flat_record(const FlatContext& context, const Triangle& t, bool rectangle, uint32_t first_primitive,
                        uint32_t hit0, uint32_t hit1) {
  LightRecord r;
  r.kind = rectangle ? gpu::kLightRectangle : gpu::kLightTriangles;
  const dvec3 v0 = t[0].p, e1 = t[1].p - v0, e2 = t[2].p - v0;
  const double area = (rectangle ? 2 : 1) * glm::length(area_vector(t));
  dvec3 n = area > 0 ? glm::normalize(area_vector(t)) : dvec3(0, 0, 1);
  const int bending = bend(t, n);
  const double side = context.flip ? -1 : 1;
  const bool smooth = bending == 2;
  n *= bending == 1 ? -side : side;

  double theta_o = 0;
  dvec3 axis = n;
  if (smooth) {
    r.flags |= gpu::kLightSmooth;
    axis = dvec3(0);
    for (const Corner& c : t) axis += side * glm::normalize(c.n);
    axis = glm::length(axis) > 1e-3 ? glm::normalize(axis) : n;
    for (const Corner& c : t)
      theta_o = std::max(theta_o, std::acos(std::clamp(side * glm::dot(glm::normalize(c.n), axis), -1.0, 1.0)));
    // A point is seen from where both its normals may look: the geometric side does not matter (see light.glsl).
    theta_o = std::min(theta_o, kPi);
  }

  double power = mean_component(context.radiance.value);
  if (context.radiance.texture) {
    const dvec3 here = mean_texture_color(context.scene, *context.radiance.texture, t[0].uv, t[1].uv - t[0].uv,
                                          t[2].uv - t[0].uv, rectangle);
    power = std::max(mean_component(here), 0.01 * power);
  }
  r.rows[0] = glm::vec4(context.radiance.value, 0);
  r.rows[1] = glm::vec4(v0, as_float(hit0));
  r.rows[2] = glm::vec4(e1, as_float(context.radiance.texture_row));
  r.rows[3] = glm::vec4(e2, as_float(hit1));
  r.rows[4] = glm::vec4(n, area);
  r.rows[5] = glm::vec4(as_float(first_primitive), 0, as_float(gpu::kNoIndex), 0);
  if (context.radiance.texture || smooth) {
    r.corners = {glm::vec4(t[0].uv, t[1].uv), glm::vec4(t[2].uv, 0, 0)};
    if (smooth)
      for (const Corner& c : t) r.corners.emplace_back(side * glm::normalize(c.n), context.density);
  }

  LightBounds& b = r.bounds;
  b.box_min = b.box_max = v0;
  for (const dvec3& p : {v0 + e1, v0 + e2, v0 + (rectangle ? e1 + e2 : e1)}) {
    b.box_min = glm::min(b.box_min, p);
    b.box_max = glm::max(b.box_max, p);
  }
  // Around the box's centre, not beyond its corners.
  const dvec3 centre = 0.5 * (b.box_min + b.box_max);
  b.radius = 0;
  for (const dvec3& p : {v0, v0 + e1, v0 + e2, v0 + (rectangle ? e1 + e2 : e1)})
    b.radius = std::max(b.radius, glm::length(p - centre));
  b.axis = axis;
  b.theta_o = theta_o;
  b.theta_e = kPi / 2;
  b.power = hit0 == gpu::kNoHit || !(area > 0) ? 0 : power * area;
  return r;
}

std::vector<LightRecord> flat_records(const Scene& scene, const Geometry& geometry, size_t s,
                                      const LightRadiance& radiance, size_t emitters,
                                      const std::vector<uint32_t>& hits) {
  const ShapeGeometry& range = geometry.shapes[s];
  const uint32_t first = range.first_primitive, count = range.primitive_count;
  const double density =
      range.has_normals ? 1 / (static_cast<double>(emitters) * mesh_area(geometry, range)) : 0;
  const FlatContext context{scene, radiance, range.flip_normals, density};
  const bool attribute = radiance.texture && reads_mesh_attribute(scene, *radiance.texture);
  const bool with_uv = radiance.texture != nullptr;
  std::vector<LightRecord> records;

  bool pairs = count % 2 == 0 && !attribute && !(with_uv && !range.has_uv);
  for (uint32_t i = 0; i < count && pairs; i += 2) {
    const Triangle a = load_triangle(geometry, range, first + i), b = load_triangle(geometry, range, first + i + 1);
    const dvec3 n = area_vector(a);
    const auto t = as_rectangle(a, b, with_uv);
    pairs = t && glm::length(n) > 0 && bend(a, glm::normalize(n)) < 2 &&
            bend(b, glm::normalize(n)) == bend(a, glm::normalize(n)) && hits[i] != gpu::kNoHit &&
            hits[i + 1] != gpu::kNoHit;
    if (pairs) {
      records.push_back(flat_record(context, *t, true, first + i, hits[i], hits[i + 1]));
      records.back().flags |= gpu::kLightPairs;
    }
  }
  if (pairs) return records;
  records.clear();
  for (uint32_t i = 0; i < count; ++i)
    records.push_back(
        flat_record(context, load_triangle(geometry, range, first + i), false, first + i, hits[i], hits[i]));
  return records;
}

LightRecord curved_record(const Scene& scene, const Geometry& geometry, size_t s, const LightRadiance& radiance,
                          uint32_t hit) {
  const ShapeGeometry& range = geometry.shapes[s];
  const CurvedPrimitive& curved = geometry.curved[range.first_primitive - geometry.triangles.size()];
  const dmat4& m = curved.object_to_world;
  const dvec3 x(m[0]), y(m[1]), z(m[2]), o(m[3]);
  const double handedness = glm::determinant(glm::dmat3(m)) < 0 ? -1 : 1;
  const double inward = range.flip_normals ? 1 : 0;
  const double value = mean_component(radiance.value);

  LightRecord r;
  r.rows[0] = glm::vec4(radiance.value, 0);
  r.rows[1] = glm::vec4(o, as_float(hit));
  r.rows[5] = glm::vec4(as_float(gpu::kNoIndex), 0, as_float(gpu::kNoIndex), 0);
  LightBounds& b = r.bounds;
  b.theta_e = kPi / 2;
  if (curved.kind == gpu::kLeafSphere) {
    r.kind = gpu::kLightSphere;
    const double a = glm::length(x), c = glm::length(y), d = glm::length(z);
    const double radius = std::cbrt(a * c * d);
    const double skew = std::max({std::abs(glm::dot(x, y)), std::abs(glm::dot(y, z)), std::abs(glm::dot(z, x))});
    if (std::max({a, c, d}) > 1.0001 * std::min({a, c, d}) || skew > 1e-4 * radius * radius)
      throw InputError(scene.shapes[s].where, "a sphere that emits must be scaled evenly; use a mesh instead");
    r.rows[2] = glm::vec4(radius, inward, 0, 0);
    r.rows[3] = glm::vec4(glm::normalize(x), handedness);
    r.rows[4] = glm::vec4(glm::normalize(z), 0);
    b.box_min = o - radius;
    b.box_max = o + radius;
    b.radius = radius;
    b.theta_o = kPi;
    b.power = value * kPi * radius * radius;
  } else if (curved.kind == gpu::kLeafDisk) {
    r.kind = gpu::kLightDisk;
    const dvec3 across = glm::cross(x, y);
    const double area = kPi * glm::length(across);
    const dvec3 n = glm::normalize(across) * handedness * (1 - 2 * inward);
    r.rows[2] = glm::vec4(x, 0);
    r.rows[3] = glm::vec4(y, 0);
    r.rows[4] = glm::vec4(n, area);
    const dvec3 half = glm::sqrt(x * x + y * y);
    b.box_min = o - half;
    b.box_max = o + half;
    b.radius = std::sqrt(glm::dot(x, x) + glm::dot(y, y));
    if (std::abs(glm::dot(x, y)) < 1e-9 * area) b.radius = std::max(glm::length(x), glm::length(y));
    b.axis = n;
    b.power = value * area;
  } else {
    r.kind = gpu::kLightCylinder;
    r.rows[2] = glm::vec4(x, 0);
    r.rows[3] = glm::vec4(y, inward);
    r.rows[4] = glm::vec4(z, 0);
    double area = 0;
    constexpr int kSteps = 64;
    for (int i = 0; i < kSteps; ++i) {
      const double phi = 2 * kPi * (i + 0.5) / kSteps;
      area += glm::length(glm::cross(std::cos(phi) * y - std::sin(phi) * x, z)) * 2 * kPi / kSteps;
    }
    const dvec3 half = glm::sqrt(x * x + y * y);
    b.box_min = glm::min(o, o + z) - half;
    b.box_max = glm::max(o, o + z) + half;
    b.theta_o = kPi;
    b.power = value * area / kPi;
  }
  r.rows[2].w = as_float(radiance.texture_row);
  return r;
}

}  // namespace

std::vector<LightRecord> area_light_records(const Scene& scene, const Geometry& geometry, size_t s,
                                            const LightRadiance& radiance, size_t emitters,
                                            const std::vector<uint32_t>& hits) {
  if (geometry.shapes[s].first_primitive >= geometry.triangles.size())
    return {curved_record(scene, geometry, s, radiance, hits.at(0))};
  return flat_records(scene, geometry, s, radiance, emitters, hits);
}

}  // namespace tachylite
