#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace tachylite::test {

/// An indexed triangle mesh made in code.
struct TestMesh {
  std::vector<glm::vec3> vertices;
  std::vector<glm::uvec3> triangles;

  void append(const TestMesh& other);
  /// Corner and two edges; two triangles, normal along cross(edge_u, edge_v).
  void add_parallelogram(const glm::vec3& corner, const glm::vec3& edge_u, const glm::vec3& edge_v);
  /// Twelve triangles; the axes span the box from its centre (half lengths).
  void add_box(const glm::vec3& centre, const glm::vec3& axis_x, const glm::vec3& axis_y, const glm::vec3& axis_z);
};

/// A sphere of 2 * (rings - 1) * segments triangles in latitude and longitude, radially displaced by up to
/// `amplitude` * radius with smooth noise chosen by `seed`. Closed: neighbours share their vertices.
TestMesh make_displaced_sphere(const glm::vec3& centre, float radius, float amplitude, uint32_t rings, uint32_t segments,
                           uint64_t seed);

/// `count` triangles with vertices uniform in a cube of edge `size` around uniform points of the unit cube.
TestMesh make_triangle_soup(uint32_t count, float size, uint64_t seed);

}  // namespace tachylite::test
