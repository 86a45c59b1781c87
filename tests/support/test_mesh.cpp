#include "support/test_mesh.h"

#include <array>

#include <glm/gtc/constants.hpp>

#include "support/pcg32.h"

namespace tachylite::test {

void TestMesh::append(const TestMesh& other) {
  const auto base = static_cast<uint32_t>(vertices.size());
  vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const glm::uvec3& triangle : other.triangles) triangles.push_back(triangle + base);
}

void TestMesh::add_parallelogram(const glm::vec3& corner, const glm::vec3& edge_u, const glm::vec3& edge_v) {
  const auto base = static_cast<uint32_t>(vertices.size());
  for (const glm::vec3& v : {corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v}) vertices.push_back(v);
  triangles.push_back({base, base + 1, base + 2});
  triangles.push_back({base, base + 2, base + 3});
}

void TestMesh::add_box(const glm::vec3& centre, const glm::vec3& axis_x, const glm::vec3& axis_y,
                   const glm::vec3& axis_z) {
  const auto base = static_cast<uint32_t>(vertices.size());
  for (uint32_t i = 0; i < 8; ++i) {
    const glm::vec3 x = i & 1 ? axis_x : -axis_x, y = i & 2 ? axis_y : -axis_y, z = i & 4 ? axis_z : -axis_z;
    vertices.push_back(centre + x + y + z);
  }
  constexpr std::array<std::array<uint32_t, 4>, 6> kFaces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& f : kFaces) {
    triangles.push_back({base + f[0], base + f[1], base + f[2]});
    triangles.push_back({base + f[0], base + f[2], base + f[3]});
  }
}

TestMesh make_displaced_sphere(const glm::vec3& centre, float radius, float amplitude, uint32_t rings, uint32_t segments,
                           uint64_t seed) {
  // A sum of plane waves of random directions; amplitudes fall as 1 / frequency.
  struct Wave {
    glm::vec3 direction;
    float phase, amplitude;
  };
  Pcg32 random(seed);
  std::array<Wave, 12> waves;
  float total = 0;
  for (size_t i = 0; i < waves.size(); ++i) {
    const float frequency = 2.0f + 1.5f * static_cast<float>(i);
    waves[i] = {random.direction() * frequency, random.uniform(0, 6.2831853f), 1 / frequency};
    total += waves[i].amplitude;
  }
  const auto displaced = [&](const glm::vec3& n) {
    float sum = 0;
    for (const Wave& wave : waves) sum += wave.amplitude * glm::sin(glm::dot(wave.direction, n) + wave.phase);
    return centre + n * (radius * (1 + amplitude * sum / total));
  };

  TestMesh mesh;
  mesh.vertices.push_back(displaced({0, 0, 1}));
  for (uint32_t ring = 1; ring < rings; ++ring) {
    const float theta = glm::pi<float>() * static_cast<float>(ring) / static_cast<float>(rings);
    for (uint32_t segment = 0; segment < segments; ++segment) {
      const float phi = glm::two_pi<float>() * static_cast<float>(segment) / static_cast<float>(segments);
      mesh.vertices.push_back(displaced(
          {glm::sin(theta) * glm::cos(phi), glm::sin(theta) * glm::sin(phi), glm::cos(theta)}));
    }
  }
  mesh.vertices.push_back(displaced({0, 0, -1}));

  const auto last = static_cast<uint32_t>(mesh.vertices.size() - 1);
  const auto at = [&](uint32_t ring, uint32_t segment) { return 1 + (ring - 1) * segments + segment % segments; };
  for (uint32_t s = 0; s < segments; ++s) mesh.triangles.push_back({0, at(1, s), at(1, s + 1)});
  for (uint32_t ring = 1; ring + 1 < rings; ++ring)
    for (uint32_t s = 0; s < segments; ++s) {
      mesh.triangles.push_back({at(ring, s), at(ring + 1, s), at(ring + 1, s + 1)});
      mesh.triangles.push_back({at(ring, s), at(ring + 1, s + 1), at(ring, s + 1)});
    }
  for (uint32_t s = 0; s < segments; ++s) mesh.triangles.push_back({at(rings - 1, s), last, at(rings - 1, s + 1)});
  return mesh;
}

TestMesh make_triangle_soup(uint32_t count, float size, uint64_t seed) {
  Pcg32 random(seed);
  TestMesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 centre = random.in_box(glm::vec3(0), glm::vec3(1));
    for (int k = 0; k < 3; ++k)
      mesh.vertices.push_back(centre + random.in_box(glm::vec3(-0.5f * size), glm::vec3(0.5f * size)));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

}  // namespace tachylite::test
