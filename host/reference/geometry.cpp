#include "reference/geometry.h"

#include "reference/analytic_shape.h"

namespace tachylite::reference {
namespace {

/// Roundings of a hit point and of the distance that a ray finds to its own surface are a few units of 2^-53
/// of the primitive's coordinates; this is 4096 of them.
constexpr double kRelativeError = 0x1p-41;

/// The vertex (0, 1, 2) opposite the longest edge. The edges that meet in it are the furthest from parallel: the plane
/// through them is off by least at the triangle's other end.
int apex_of(const dvec3& a, const dvec3& b, const dvec3& c) {
  const double bc = glm::dot(c - b, c - b), ca = glm::dot(a - c, a - c), ab = glm::dot(b - a, b - a);
  return bc >= ca && bc >= ab ? 0 : ca >= ab ? 1 : 2;
}

/// On which side of the line from the origin to p the point q is: the sign of p x q, or 0. Rounding is monotonic: the
/// sign is never the wrong one, and that of (q, p) is the opposite.
int side(const dvec2& p, const dvec2& q) {
  const double a = p.x * q.y, b = p.y * q.x;
  return (a > b) - (a < b);
}

}  // namespace

/// Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection": vertices are sheared, each alone, so that the
/// ray becomes the z axis. Triangles that share an edge see it at the same place, and no ray passes between them.
struct Geometry::ShearedRay {
  const Ray& ray;
  int x, y, z;  // axes; z is the one that the ray is most along
  double shear_x, shear_y;

  explicit ShearedRay(const Ray& r) : ray(r) {
    const dvec3 d = glm::abs(ray.direction);
    z = d.x > d.y && d.x > d.z ? 0 : d.y > d.z ? 1 : 2;
    x = (z + 1) % 3;
    y = (z + 2) % 3;
    shear_x = ray.direction[x] / ray.direction[z];
    shear_y = ray.direction[y] / ray.direction[z];
  }
  dvec2 operator()(const dvec3& p) const {
    const dvec3 s = p - ray.origin;
    return {s[x] - shear_x * s[z], s[y] - shear_y * s[z]};
  }
  double distance(const dvec3& p) const { return (p[z] - ray.origin[z]) / ray.direction[z]; }
};

Geometry::Geometry(const Scene& scene) : scene_(scene) {
  std::vector<Box> boxes;
  for (const Shape& shape : scene.shapes) {
    const int shape_index = static_cast<int>(shapes_.size());
    WorldShape& world = shapes_.emplace_back();
    if (const auto* mesh = std::get_if<MeshShape>(&shape.kind)) world.mesh = mesh->mesh;
    if (std::holds_alternative<CubeShape>(shape.kind)) world.mesh = make_cube_mesh();
    world.to_world = world.mesh ? shape.to_world : unit_shape_to_world(shape);
    world.to_object = glm::inverse(world.to_world);
    world.normal_to_world = glm::transpose(dmat3(world.to_object));

    Box bounds;
    auto add = [&](uint32_t triangle, const Box& box, int apex = 0) {
      primitives_.push_back({shape_index, triangle, apex});
      boxes.push_back(box);
      bounds.grow(box);
    };
    if (world.mesh) {
      for (const glm::vec3& p : world.mesh->positions)
        world.positions.push_back(transform_point(world.to_world, p));
      if (!shape.face_normals)
        for (const glm::vec3& n : world.mesh->normals) {
          const dvec3 turned = world.normal_to_world * dvec3(n);
          world.normals.push_back(glm::dot(turned, turned) > 0 ? glm::normalize(turned) : dvec3(0));
        }
      for (uint32_t i = 0; i < world.mesh->triangles.size(); ++i) {
        const glm::uvec3 v = world.mesh->triangles[i];
        const dvec3 a = world.positions[v.x], b = world.positions[v.y], c = world.positions[v.z];
        world.area += 0.5 * glm::length(glm::cross(b - a, c - a));
        world.triangle_area_sums.push_back(world.area);
        Box box;
        for (const dvec3& p : {a, b, c}) box.grow(p);
        add(i, box, apex_of(a, b, c));
      }
    } else {
      world.area = unit_shape_area(shape, world.to_world);
      Box box;  // of the box around the unit shape
      for (int corner = 0; corner < 8; ++corner) {
        dvec3 p((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1, (corner & 4) ? 1 : -1);
        if (std::holds_alternative<CylinderShape>(shape.kind)) p.z = std::max(p.z, 0.0);
        if (std::holds_alternative<RectangleShape>(shape.kind) ||
            std::holds_alternative<DiskShape>(shape.kind))
          p.z = 0;
        box.grow(transform_point(world.to_world, p));
      }
      add(0, box);
    }
    world.error = kRelativeError * std::max(max_abs(bounds.low), max_abs(bounds.high));
  }

  // Pad the boxes by the error: analytic hits are found in another space.
  for (size_t i = 0; i < boxes.size(); ++i) {
    const double error = shapes_[static_cast<size_t>(primitives_[i].shape)].error;
    boxes[i].low -= error;
    boxes[i].high += error;
  }
  bvh_ = Bvh2(boxes);
}

std::optional<Geometry::Candidate> Geometry::intersect_primitive(const Primitive& primitive, const ShearedRay& sheared,
                                                                 double t_max) const {
  const Ray& ray = sheared.ray;
  const WorldShape& world = shapes_[static_cast<size_t>(primitive.shape)];
  if (!world.mesh) {
    const auto hit = intersect_unit_shape(scene_.shapes[static_cast<size_t>(primitive.shape)],
                                          transform_point(world.to_object, ray.origin),
                                          transform_vector(world.to_object, ray.direction), t_max);
    if (!hit) return std::nullopt;
    return Candidate{hit->t, hit->p};
  }
  // Edges belong to both triangles.
  const glm::uvec3 v = world.mesh->triangles[primitive.triangle];
  const int i0 = primitive.apex, i1 = (i0 + 1) % 3, i2 = (i0 + 2) % 3;
  const dvec3 v0 = world.positions[v[i0]], v1 = world.positions[v[i1]], v2 = world.positions[v[i2]];
  const dvec2 p0 = sheared(v0), p1 = sheared(v1), p2 = sheared(v2);
  const int s0 = side(p1, p2), s1 = side(p2, p0), s2 = side(p0, p1);
  if (std::min({s0, s1, s2}) < 0 && std::max({s0, s1, s2}) > 0) return std::nullopt;
  if (s0 == 0 && s1 == 0 && s2 == 0) return std::nullopt;  // edge-on

  // Moeller and Trumbore 1997: more accurate than what interpolates between vertices, but for edges.
  const dvec3 e1 = v1 - v0, e2 = v2 - v0;
  const dvec3 q = glm::cross(ray.direction, e2);
  const double determinant = glm::dot(e1, q);
  const dvec3 s = ray.origin - v0;
  const dvec3 r = glm::cross(s, e1);
  double b1 = glm::dot(s, q) / determinant, b2 = glm::dot(ray.direction, r) / determinant;
  double t = glm::dot(e2, r) / determinant;
  if (!(b1 >= 0 && b2 >= 0 && b1 + b2 <= 1)) {  // rounded to the other side of an edge, or nearly edge-on
    const auto area = [](const dvec2& a, const dvec2& b) { return std::abs(a.x * b.y - a.y * b.x); };
    const double a0 = area(p1, p2), a1 = area(p2, p0), a2 = area(p0, p1), sum = a0 + a1 + a2;
    b1 = a1 / sum;
    b2 = a2 / sum;
    t = (a0 * sheared.distance(v0) + a1 * sheared.distance(v1) + a2 * sheared.distance(v2)) / sum;
  }
  if (!(t > 0 && t < t_max)) return std::nullopt;
  dvec3 where;
  where[i0] = 1 - b1 - b2;
  where[i1] = b1;
  where[i2] = b2;
  return Candidate{t, where};
}

std::optional<SurfacePoint> Geometry::intersect(const Ray& ray, bool without_emitters) const {
  std::optional<Candidate> nearest;
  Primitive primitive{};
  const ShearedRay sheared(ray);
  bvh_.traverse(ray, [&](uint32_t item, double& t_max) {
    const Primitive& candidate = primitives_[item];
    if (without_emitters && scene_.shapes[static_cast<size_t>(candidate.shape)].emitter != kNone)
      return false;
    if (const auto hit = intersect_primitive(candidate, sheared, t_max)) {
      nearest = hit;
      primitive = candidate;
      t_max = hit->t;
    }
    return false;
  });
  if (!nearest) return std::nullopt;
  SurfacePoint point = surface_point(primitive, nearest->where);
  point.t = nearest->t;
  return point;
}

bool Geometry::occluded(const Ray& ray) const {
  const ShearedRay sheared(ray);
  return bvh_.traverse(ray, [&](uint32_t item, double& t_max) {
    return intersect_primitive(primitives_[item], sheared, t_max).has_value();
  });
}

SurfacePoint Geometry::surface_point(const Primitive& primitive, const dvec3& where) const {
  const WorldShape& world = shapes_[static_cast<size_t>(primitive.shape)];
  SurfacePoint point = world.mesh ? triangle_point(primitive, where) : analytic_point(primitive, where);
  point.shape = primitive.shape;
  point.error = world.error;
  if (scene_.shapes[static_cast<size_t>(primitive.shape)].flip_normals) {
    point.n_g = -point.n_g;
    point.frame.n = -point.frame.n;
  }
  point.frame = frame_around(point.frame.n, point.dp_du);
  return point;
}

SurfacePoint Geometry::triangle_point(const Primitive& primitive, const dvec3& b) const {
  const WorldShape& world = shapes_[static_cast<size_t>(primitive.shape)];
  const Mesh& mesh = *world.mesh;
  const glm::uvec3 v = mesh.triangles[primitive.triangle];
  const dvec3 p0 = world.positions[v.x], p1 = world.positions[v.y], p2 = world.positions[v.z];
  SurfacePoint point;
  point.p = b.x * p0 + b.y * p1 + b.z * p2;
  const int i0 = apex_of(p0, p1, p2);
  const dvec3 corners[] = {p0, p1, p2}, apex = corners[i0];
  point.n_g = glm::normalize(glm::cross(corners[(i0 + 1) % 3] - apex, corners[(i0 + 2) % 3] - apex));
  point.at = {dvec2(b.y, b.z), &mesh, primitive.triangle, b};

  // Interpolate the normal.
  point.frame.n = point.n_g;
  if (!world.normals.empty()) {
    const dvec3 n = b.x * world.normals[v.x] + b.y * world.normals[v.y] + b.z * world.normals[v.z];
    if (glm::dot(n, n) > 0) point.frame.n = glm::normalize(n);
  }

  // Derivatives w.r.t. uv; without uv, or where they are degenerate, any frame of the triangle.
  const Frame any = frame_around(point.n_g);
  point.dp_du = any.s;
  point.dp_dv = any.t;
  if (!mesh.uvs.empty()) {
    const dvec2 uv0 = mesh.uvs[v.x], uv1 = mesh.uvs[v.y], uv2 = mesh.uvs[v.z];
    point.at.uv = b.x * uv0 + b.y * uv1 + b.z * uv2;
    const dvec2 d1 = uv1 - uv0, d2 = uv2 - uv0;
    const double determinant = d1.x * d2.y - d1.y * d2.x;
    if (determinant != 0) {
      point.dp_du = (d2.y * (p1 - p0) - d1.y * (p2 - p0)) / determinant;
      point.dp_dv = (d1.x * (p2 - p0) - d2.x * (p1 - p0)) / determinant;
    }
  }
  return point;
}

SurfacePoint Geometry::analytic_point(const Primitive& primitive, const dvec3& object_point) const {
  const WorldShape& world = shapes_[static_cast<size_t>(primitive.shape)];
  const UnitShapePoint unit =
      unit_shape_point(scene_.shapes[static_cast<size_t>(primitive.shape)], object_point);
  SurfacePoint point;
  point.p = transform_point(world.to_world, object_point);
  point.n_g = glm::normalize(world.normal_to_world * unit.normal);
  point.frame.n = point.n_g;
  point.at.uv = unit.uv;
  point.dp_du = transform_vector(world.to_world, unit.dp_du);
  point.dp_dv = transform_vector(world.to_world, unit.dp_dv);
  return point;
}

AreaSample Geometry::sample_area(int shape, Random& random) const {
  const WorldShape& world = shapes_[static_cast<size_t>(shape)];
  if (!world.mesh) {
    const dvec3 where = sample_unit_shape(scene_.shapes[static_cast<size_t>(shape)], random.uniform2());
    return {surface_point({.shape = shape, .triangle = 0}, where), 1 / world.area};
  }
  const auto& sums = world.triangle_area_sums;
  const auto chosen = std::upper_bound(sums.begin(), sums.end(), random.uniform() * world.area);
  const size_t triangle = std::min(static_cast<size_t>(chosen - sums.begin()), sums.size() - 1);
  const dvec2 u = random.uniform2();
  const double r = std::sqrt(u.x);  // uniform on the triangle
  const dvec3 barycentrics(1 - r, r * (1 - u.y), r * u.y);
  return {surface_point({.shape = shape, .triangle = static_cast<uint32_t>(triangle)}, barycentrics), 1 / world.area};
}

}  // namespace tachylite::reference
