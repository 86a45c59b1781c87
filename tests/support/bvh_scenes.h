#pragma once

// Random geometry for the tests of the BVH, the same on every run.

#include <cmath>
#include <random>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "accel/bvh.h"

namespace tachylite::test {

struct TestScene {
  std::vector<glm::vec3> vertices;
  std::vector<glm::uvec3> triangles;
  std::vector<CurvedPrimitive> curved;
  std::vector<uint32_t> groups;

  BvhInput input() const { return {vertices, triangles, curved, groups}; }
  void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const auto n = static_cast<uint32_t>(vertices.size());
    vertices.insert(vertices.end(), {a, b, c});
    triangles.emplace_back(n, n + 1, n + 2);
  }
};

class RandomPlaces {
 public:
  explicit RandomPlaces(uint32_t seed) : engine_(seed) {}
  /// In [lo, hi). Written out, because std::uniform_real_distribution differs between libraries.
  double uniform(double lo = 0, double hi = 1) { return lo + (hi - lo) * (engine_() * 0x1p-32); }
  glm::dvec3 in_cube(double half) {
    return {uniform(-half, half), uniform(-half, half), uniform(-half, half)};
  }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 v = in_cube(1);
      const double length = glm::length(v);
      if (length > 1e-2 && length <= 1) return v / length;
    }
  }

 private:
  std::mt19937 engine_;
};

/// Unconnected triangles of about `size` in the cube [-1, 1]^3.
inline TestScene triangle_soup(int count, double size, uint32_t seed) {
  TestScene s;
  RandomPlaces random(seed);
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 p = random.in_cube(1);
    s.add(p + random.in_cube(size), p + random.in_cube(size), p + random.in_cube(size));
  }
  return s;
}

/// A bumpy sphere of 2 * (rings - 1) * segments triangles, indexed.
inline TestScene bumpy_sphere(int rings, int segments, double bump, uint32_t seed) {
  TestScene s;
  RandomPlaces random(seed);
  s.vertices.emplace_back(0, 0, 1);
  for (int r = 1; r < rings; ++r)
    for (int k = 0; k < segments; ++k) {
      const double theta = M_PI * r / rings, phi = 2 * M_PI * k / segments;
      const double radius = 1 + bump * random.uniform(-1, 1);
      s.vertices.emplace_back(radius * sin(theta) * cos(phi), radius * sin(theta) * sin(phi),
                              radius * cos(theta));
    }
  s.vertices.emplace_back(0, 0, -1);
  const auto at = [&](int r, int k) { return static_cast<uint32_t>(1 + (r - 1) * segments + k % segments); };
  const auto last = static_cast<uint32_t>(s.vertices.size() - 1);
  for (int k = 0; k < segments; ++k) {
    s.triangles.emplace_back(0, at(1, k), at(1, k + 1));
    for (int r = 1; r + 1 < rings; ++r) {
      s.triangles.emplace_back(at(r, k), at(r + 1, k), at(r + 1, k + 1));
      s.triangles.emplace_back(at(r, k), at(r + 1, k + 1), at(r, k + 1));
    }
    s.triangles.emplace_back(at(rings - 1, k), last, at(rings - 1, k + 1));
  }
  return s;
}

/// Needles: one edge 1e5 times longer than the height.
inline TestScene slivers(int count, uint32_t seed) {
  TestScene s;
  RandomPlaces random(seed);
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 p = random.in_cube(1), d = random.direction();
    s.add(p - d, p + d, p + d * random.uniform(-1, 1) + 1e-5 * random.direction());
  }
  return s;
}

/// Parallel quads of two triangles in few planes, many of them several times over.
inline TestScene coplanar_duplicates(int quads, uint32_t seed) {
  TestScene s;
  RandomPlaces random(seed);
  for (int i = 0; i < quads; ++i) {
    const auto x = static_cast<float>(std::floor(random.uniform(-4, 4)) / 4);
    const auto y = static_cast<float>(std::floor(random.uniform(-4, 4)) / 4);
    const auto z = static_cast<float>(std::floor(random.uniform(-2, 2)) / 2);
    const glm::vec3 a(x, y, z), b(x + .25f, y, z), c(x + .25f, y + .25f, z), d(x, y + .25f, z);
    s.add(a, b, c);
    s.add(a, c, d);
  }
  return s;
}

/// Triangles of sizes from 1e-6 to 1e3 around the origin.
inline TestScene huge_and_tiny(int count, uint32_t seed) {
  TestScene s;
  RandomPlaces random(seed);
  for (int i = 0; i < count; ++i) {
    const double size = std::pow(10.0, random.uniform(-6, 3));
    const glm::dvec3 p = random.in_cube(1);
    s.add(p + random.in_cube(size), p + random.in_cube(size), p + random.in_cube(size));
  }
  return s;
}

/// Spheres, disks and cylinders under general affine maps.
inline void add_curved(TestScene& s, int count, uint32_t seed) {
  RandomPlaces random(seed);
  for (int i = 0; i < count; ++i) {
    glm::dmat4 m = glm::translate(glm::dmat4(1), random.in_cube(1));
    m = glm::rotate(m, random.uniform(0, 6), random.direction());
    m = glm::scale(m,
                   glm::dvec3(random.uniform(.01, .2), random.uniform(.01, .2), random.uniform(-.2, -.01)));
    m = glm::rotate(m, random.uniform(0, 6), random.direction());
    s.curved.push_back({gpu::kLeafSphere + static_cast<uint32_t>(i % 3), m});
  }
}

/// The parallelogram corner + s a + t b, s and t in [0, 1].
inline void add_parallelogram(TestScene& scene, const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b) {
  scene.add(corner, corner + a, corner + a + b);
  scene.add(corner, corner + a + b, corner + b);
}

/// Five walls of [-1, 1]^3 (triangles 0 to 9, two each), a lamp of 0.2 below the ceiling, and a thousand small triangles.
inline TestScene furnished_room() {
  TestScene scene;
  const glm::vec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2), low(-1);
  add_parallelogram(scene, low, x, z);
  add_parallelogram(scene, low + y, z, x);
  add_parallelogram(scene, low, y, x);
  add_parallelogram(scene, low, z, y);
  add_parallelogram(scene, low + x, y, z);
  add_parallelogram(scene, {-.1f, .99f, -.1f}, {.2f, 0, 0}, {0, 0, .2f});
  const TestScene soup = triangle_soup(1000, .05, 17);
  for (const glm::uvec3& t : soup.triangles)
    scene.add(.3f * soup.vertices[t.x], .3f * soup.vertices[t.y], .3f * soup.vertices[t.z]);
  return scene;
}

}  // namespace tachylite::test
