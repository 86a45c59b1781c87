#include "pack/pack_geometry.h"

#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"

namespace tachylite {
namespace {

using glm::dmat3;
using glm::dmat4;
using glm::dvec3;
using glm::dvec4;

constexpr size_t kMaxPrimitives = size_t{1} << 30;  // a hit is 2 * leaf + triangle in 32 bits

using Face = std::array<dvec3, 4>;  // corners, counter-clockwise from outside

// The faces of [-1, 1]^3; their corners have uv kCubeUv, as Mitsuba's cube has them.
constexpr int kCubeFaces = 6;
const std::array<Face, kCubeFaces> kCube = {{
    {{{1, -1, -1}, {1, -1, 1}, {-1, -1, 1}, {-1, -1, -1}}},
    {{{1, 1, -1}, {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}}},
    {{{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}}},
    {{{1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}}},
    {{{-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, -1}}},
    {{{1, 1, -1}, {1, -1, -1}, {-1, -1, -1}, {-1, 1, -1}}},
}};
const Face kRectangle = {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};
using FaceUv = std::array<glm::vec2, 4>;
const FaceUv kCubeUv = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
const FaceUv kRectangleUv = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

dvec3 transform_point(const dmat4& m, const dvec3& p) { return dvec3(m * dvec4(p, 1)); }

// The transform of the unit sphere, disk or cylinder of shared/bvh.h to the world.
CurvedPrimitive curved_primitive(const Shape& shape) {
  CurvedPrimitive curved;
  if (const auto* sphere = std::get_if<SphereShape>(&shape.kind)) {
    curved.kind = gpu::kLeafSphere;
    const double r = sphere->radius;
    const dmat4 local(dvec4(r, 0, 0, 0), dvec4(0, r, 0, 0), dvec4(0, 0, r, 0), dvec4(sphere->center, 1));
    curved.object_to_world = shape.to_world * local;
  } else if (std::holds_alternative<DiskShape>(shape.kind)) {
    curved.kind = gpu::kLeafDisk;
    curved.object_to_world = shape.to_world;
  } else {
    const auto& cylinder = std::get<CylinderShape>(shape.kind);
    curved.kind = gpu::kLeafCylinder;
    const dvec3 axis = cylinder.p1 - cylinder.p0;
    const dvec3 w = glm::normalize(axis);
    // The frame around the axis as Mitsuba's coordinate_system builds it: u = 0 lies along s.
    const double sign = std::copysign(1.0, w.z), a = -1.0 / (sign + w.z), b = w.x * w.y * a;
    const dvec3 s(w.x * w.x * a * sign + 1.0, b * sign, -w.x * sign), t(b, w.y * w.y * a + sign, -w.y);
    const double r = cylinder.radius;
    curved.object_to_world =
        shape.to_world * dmat4(dvec4(s * r, 0), dvec4(t * r, 0), dvec4(axis, 0), dvec4(cylinder.p0, 1));
  }
  return curved;
}

struct Counts {
  size_t vertices = 0, triangles = 0, curved = 0;
};

Counts counts_of(const Shape& shape) {
  if (const auto* mesh = std::get_if<MeshShape>(&shape.kind))
    return {mesh->mesh->positions.size(), mesh->mesh->triangles.size(), 0};
  if (std::holds_alternative<RectangleShape>(shape.kind)) return {4, 2, 0};
  if (std::holds_alternative<CubeShape>(shape.kind)) return {4 * kCubeFaces, 2 * kCubeFaces, 0};
  return {0, 0, 1};
}

struct Bounds {
  dvec3 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
  void add(const dvec3& p) {
    min = glm::min(min, p);
    max = glm::max(max, p);
  }
};

void add_world_bounds(const Shape& shape, Bounds& bounds) {
  if (const auto* mesh = std::get_if<MeshShape>(&shape.kind)) {
    const std::vector<glm::vec3>& positions = mesh->mesh->positions;
    std::vector<Bounds> parts((positions.size() + kMeshGrain - 1) / kMeshGrain);
    parallel_for_each(parts.size(), [&](size_t part) {
      const size_t first = part * kMeshGrain, last = std::min(first + kMeshGrain, positions.size());
      for (size_t i = first; i < last; ++i) parts[part].add(transform_point(shape.to_world, dvec3(positions[i])));
    });
    for (const Bounds& part : parts) {
      bounds.min = glm::min(bounds.min, part.min);
      bounds.max = glm::max(bounds.max, part.max);
    }
  } else if (std::holds_alternative<RectangleShape>(shape.kind)) {
    for (const dvec3& p : kRectangle) bounds.add(transform_point(shape.to_world, p));
  } else if (std::holds_alternative<CubeShape>(shape.kind)) {
    for (int i = 0; i < 8; ++i)
      bounds.add(transform_point(shape.to_world, dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  } else {
    // The box of the unit shape's own box: enough for a centre and a radius.
    const dmat4 m = curved_primitive(shape).object_to_world;
    for (int i = 0; i < 8; ++i)
      bounds.add(transform_point(m, dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  }
}

// Writes one flat quadrilateral as two triangles that share the diagonal between corners 0 and 2.
void put_face(const Face& face, const FaceUv& uv, const dmat4& to_device, size_t vertex, size_t triangle, Geometry& out) {
  for (size_t k = 0; k < 4; ++k) {
    out.vertices[vertex + k] = glm::vec3(transform_point(to_device, face[k]));
    out.uvs[vertex + k] = uv[k];
  }
  const auto v = static_cast<uint32_t>(vertex);
  out.triangles[triangle] = {v, v + 1, v + 2};
  out.triangles[triangle + 1] = {v, v + 2, v + 3};
}

void put_mesh(const Shape& shape, const dmat4& to_device, const ShapeGeometry& range, Geometry& out) {
  const Mesh& mesh = *std::get<MeshShape>(shape.kind).mesh;
  const dmat3 normal_matrix = glm::transpose(glm::inverse(dmat3(shape.to_world)));
  parallel_for(0, mesh.positions.size(), kMeshGrain, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      const size_t v = range.first_vertex + i;
      out.vertices[v] = glm::vec3(transform_point(to_device, dvec3(mesh.positions[i])));
      if (range.has_normals) {
        const dvec3 n = normal_matrix * dvec3(mesh.normals[i]);
        const double length = glm::length(n);
        out.normals[v] = length > 0 ? glm::vec3(n / length) : glm::vec3(0);
      }
      if (range.has_uv) out.uvs[v] = mesh.uvs[i];
    }
  });
  parallel_for(0, mesh.triangles.size(), kMeshGrain, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i)
      out.triangles[range.first_primitive + i] = mesh.triangles[i] + glm::uvec3(range.first_vertex);
  });
}

}  // namespace

Geometry pack_geometry(const Scene& scene) {
  Geometry out;
  Bounds world;
  Counts total;
  bool any_normals = false, any_uv = false;
  for (const Shape& shape : scene.shapes) {
    add_world_bounds(shape, world);
    const Counts c = counts_of(shape);
    total.vertices += c.vertices;
    total.triangles += c.triangles;
    total.curved += c.curved;
    const auto* mesh = std::get_if<MeshShape>(&shape.kind);
    any_normals |= mesh && !shape.face_normals && !mesh->mesh->normals.empty();
    any_uv |= mesh ? !mesh->mesh->uvs.empty() : c.triangles > 0;
    if (total.triangles + total.curved > kMaxPrimitives || total.vertices > kMaxPrimitives)
      throw InputError(shape.where, fmt::format("the scene has more than {} primitives", kMaxPrimitives));
    if (!std::isfinite(glm::dot(world.max - world.min, dvec3(1))))
      throw InputError(shape.where, "the shape's transformed coordinates are not finite");
  }
  if (!scene.shapes.empty()) out.centre = 0.5 * (world.min + world.max);
  out.box_min = scene.shapes.empty() ? dvec3(0) : world.min - out.centre;
  out.box_max = scene.shapes.empty() ? dvec3(0) : world.max - out.centre;
  // Products of three coordinates must stay finite in float.
  const dvec3 half = 0.5 * (out.box_max - out.box_min);
  if (std::max({half.x, half.y, half.z}) > 1e12)
    throw InputError(fmt::format("{}: the scene is {:g} units large; at most 1e12 can be rendered", scene.path,
                                 2 * std::max({half.x, half.y, half.z})));

  // What the arrays below, the tree and its building take at their peak.
  constexpr uint64_t kBytesOfPrimitive = 200, kBytesOfVertex = 24;
  require_memory({std::make_shared<const std::string>(scene.path), 0},
                 fmt::format("a scene of {} primitives", total.triangles + total.curved),
                 kBytesOfPrimitive * (total.triangles + total.curved) + kBytesOfVertex * total.vertices);

  out.vertices.resize(total.vertices);
  if (any_normals) out.normals.assign(total.vertices, glm::vec3(0));
  if (any_uv) out.uvs.assign(total.vertices, glm::vec2(0));
  out.triangles.resize(total.triangles);
  out.shape_of_triangle.resize(total.triangles);

  size_t vertex = 0, triangle = 0;
  for (size_t s = 0; s < scene.shapes.size(); ++s) {
    const Shape& shape = scene.shapes[s];
    const Counts c = counts_of(shape);
    ShapeGeometry range;
    range.first_vertex = static_cast<uint32_t>(vertex);
    range.vertex_count = static_cast<uint32_t>(c.vertices);
    range.flip_normals = shape.flip_normals;
    if (c.curved > 0) {
      range.first_primitive = static_cast<uint32_t>(total.triangles + out.curved.size());
      range.primitive_count = 1;
      CurvedPrimitive curved = curved_primitive(shape);
      curved.object_to_world[3] -= dvec4(out.centre, 0);
      out.curved.push_back(curved);
      out.shape_of_curved.push_back(static_cast<uint32_t>(s));
    } else {
      range.first_primitive = static_cast<uint32_t>(triangle);
      range.primitive_count = static_cast<uint32_t>(c.triangles);
      for (size_t i = 0; i < c.triangles; ++i) out.shape_of_triangle[triangle + i] = static_cast<uint32_t>(s);
      if (const auto* mesh = std::get_if<MeshShape>(&shape.kind)) {
        range.has_normals = !shape.face_normals && !mesh->mesh->normals.empty();
        range.has_uv = !mesh->mesh->uvs.empty();
      } else {
        range.has_uv = true;
        // The winding turns with a mirroring transform; the normal (inverse transpose) does not.
        range.flip_normals = shape.flip_normals != (glm::determinant(dmat3(shape.to_world)) < 0);
      }
    }
    out.shapes.push_back(range);
    vertex += c.vertices;
    triangle += c.triangles;
  }

  parallel_for(0, scene.shapes.size(), 1, [&](size_t first, size_t last) {
    for (size_t s = first; s < last; ++s) {
      const Shape& shape = scene.shapes[s];
      const ShapeGeometry& range = out.shapes[s];
      dmat4 to_device = shape.to_world;
      to_device[3] -= dvec4(out.centre, 0);
      if (std::holds_alternative<MeshShape>(shape.kind)) {
        put_mesh(shape, to_device, range, out);
      } else if (std::holds_alternative<RectangleShape>(shape.kind)) {
        put_face(kRectangle, kRectangleUv, to_device, range.first_vertex, range.first_primitive, out);
      } else if (std::holds_alternative<CubeShape>(shape.kind)) {
        for (size_t f = 0; f < kCubeFaces; ++f)
          put_face(kCube[f], kCubeUv, to_device, range.first_vertex + 4 * f,
                   range.first_primitive + 2 * f, out);
      }
    }
  });
  return out;
}

}  // namespace tachylite
