#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "accel/bvh.h"
#include "base/bulk_vector.h"
#include "scene/scene.h"

namespace tachylite {

/// The primitives of one shape of the scene: a contiguous range of primitive numbers.
struct ShapeGeometry {
  uint32_t first_primitive = 0, primitive_count = 0;
  uint32_t first_vertex = 0, vertex_count = 0;  // of its triangles
  bool flip_normals = false;      // of the records: the winding may already point the other way
  bool has_uv = false, has_normals = false;
};

/// All shapes as triangles and curved primitives in device space (world space - centre, rounded to float).
/// Triangles come first: primitive i < triangles.size() is a triangle, the others are curved[i - triangles.size()].
struct Geometry {
  glm::dvec3 centre{0};
  std::vector<glm::vec3> vertices;
  std::vector<glm::vec3> normals;  // zero where the shape is flat; empty if all are
  PageVector<glm::vec2> uvs;       // zero where there are none; empty if none has
  std::vector<glm::uvec3> triangles;
  std::vector<uint32_t> shape_of_triangle;
  std::vector<CurvedPrimitive> curved;  // object_to_world maps to device space
  std::vector<uint32_t> shape_of_curved;
  std::vector<ShapeGeometry> shapes;    // as Scene::shapes
  glm::dvec3 box_min{0}, box_max{0};    // device space
};

/// Throws InputError where a coordinate does not fit into float or there are too many primitives.
Geometry pack_geometry(const Scene& scene);

}  // namespace tachylite
