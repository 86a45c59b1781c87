#include "support/edge_rays.h"

#include <cstdlib>
#include <utility>

#include <fmt/format.h>

namespace tachylite::test {
namespace {

/// The corners of 3 x 3 x 3 boxes lie `off` a grid of pitch 2. All boxes but the one in the middle, or that one alone.
TestScene boxes_of_grid(bool middle, double off, uint32_t seed) {
  constexpr int kBoxes = 3, kCorners = kBoxes + 1;
  TestScene scene;
  RandomPlaces random(seed);
  std::vector<glm::vec3> corners;
  for (int i = 0; i < kCorners * kCorners * kCorners; ++i) {
    const glm::dvec3 p(i % kCorners, i / kCorners % kCorners, i / kCorners / kCorners);
    corners.emplace_back(2.0 * p - double(kBoxes) + random.in_cube(off));
  }
  for (int box = 0; box < kBoxes * kBoxes * kBoxes; ++box) {
    const glm::ivec3 at(box % kBoxes, box / kBoxes % kBoxes, box / kBoxes / kBoxes);
    if ((at == glm::ivec3(kBoxes / 2)) != middle) continue;
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        const auto corner = [&](int u, int v) {
          glm::ivec3 p = at;
          p[axis] += side;
          p[(axis + 1) % 3] += u;
          p[(axis + 2) % 3] += v;
          return corners[static_cast<size_t>((p.z * kCorners + p.y) * kCorners + p.x)];
        };
        scene.add(corner(0, 0), corner(1, 0), corner(1, 1));
        scene.add(corner(0, 0), corner(1, 1), corner(0, 1));
      }
  }
  return scene;
}

std::vector<EdgeRay> rays_at_edges(const ClosedMesh& mesh, RayPrecision precision, size_t count, uint32_t seed) {
  const TestScene& aim = mesh.aim;
  RandomPlaces random(seed);
  std::vector<EdgeRay> rays(count);
  for (size_t i = 0; i < count; ++i) {
    const glm::uvec3& t =
        aim.triangles[static_cast<size_t>(random.uniform() * static_cast<double>(aim.triangles.size()))];
    const int k = static_cast<int>(random.uniform(0, 3));
    const glm::dvec3 a(aim.vertices[t[k]]), b(aim.vertices[t[(k + 1) % 3]]);
    const glm::dvec3 target = i % 3 == 0 ? a : a + random.uniform() * (b - a);
    EdgeRay& ray = rays[i];
    ray.origin = mesh.centre + random.in_cube(mesh.spread);
    if (precision == RayPrecision::kFloat) {
      ray.origin = glm::dvec3(glm::vec3(ray.origin));
      const glm::vec3 direction(target - ray.origin);
      ray.direction = glm::dvec3(i % 2 ? glm::normalize(direction) : direction);
    } else {
      ray.direction = target - ray.origin;
      if (i % 2) ray.direction = glm::normalize(ray.direction);
    }
    if (mesh.in_view) ray.t_max = 1.0001 * glm::distance(ray.origin, target) / glm::length(ray.direction);
  }
  return rays;
}

}  // namespace

std::vector<ClosedMesh> closed_meshes() {
  std::vector<ClosedMesh> meshes;
  for (const auto& [scale, offset] : {std::pair{1.0, 0.0}, {1e-4, 0.0}, {1e6, 0.0}, {1.0, 300.0}}) {
    TestScene scene = bumpy_sphere(40, 80, .1, 12);
    for (glm::vec3& v : scene.vertices) v = glm::vec3(glm::dvec3(v) * scale + offset);
    meshes.push_back({fmt::format("scale {}, at {}", scale, offset), scene, scene, glm::dvec3(offset), .3 * scale, 13});
  }
  return meshes;
}

ClosedMesh thin_closed_mesh() {
  TestScene scene = bumpy_sphere(30, 60, .02, 14);
  for (glm::vec3& v : scene.vertices) v.z *= 1e-3f;
  return {"thin", scene, scene, glm::dvec3(0), 1e-4, 15};
}

std::vector<ClosedMesh> touching_boxes() {
  std::vector<ClosedMesh> meshes;
  for (const double off : {0.0, 0.2})
    meshes.push_back({fmt::format("boxes off their grid by {}", off), boxes_of_grid(false, off, 24),
                      boxes_of_grid(true, off, 24), glm::dvec3(0), 0.7, 25, off == 0});
  return meshes;
}

void for_rays_at_edges(const ClosedMesh& mesh, RayPrecision precision, size_t usually,
                       const std::function<void(const std::vector<EdgeRay>&)>& visit) {
  constexpr size_t kBatch = 1000000;
  const char* wanted = std::getenv("TACHYLITE_EDGE_RAYS");
  uint32_t seed = mesh.seed;
  for (size_t left = wanted ? std::strtoull(wanted, nullptr, 10) : usually; left > 0; ++seed) {
    const size_t count = std::min(left, kBatch);
    visit(rays_at_edges(mesh, precision, count, seed));
    left -= count;
  }
}

TestScene tessellated_box(int n) {
  TestScene scene;
  for (int axis = 0; axis < 3; ++axis)
    for (float side : {-1.0f, 1.0f})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int u, int v) {
            glm::vec3 p;
            p[axis] = side;
            p[(axis + 1) % 3] = -1 + 2 * static_cast<float>(u) / static_cast<float>(n);
            p[(axis + 2) % 3] = -1 + 2 * static_cast<float>(v) / static_cast<float>(n);
            return p;
          };
          scene.add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
          scene.add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
  return scene;
}

std::vector<EdgeRay> axis_parallel_rays(int n) {
  const int steps = 4 * n;
  const auto place = [&](int i) { return double{-1 + 2 * static_cast<float>(i) / static_cast<float>(steps)}; };
  std::vector<EdgeRay> rays;
  for (int axis = 0; axis < 3; ++axis)
    for (double sign : {-1.0, 1.0})
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; j <= steps; ++j) {
          EdgeRay& ray = rays.emplace_back();
          ray.origin[axis] = 0.25;
          ray.origin[(axis + 1) % 3] = place(i);
          ray.origin[(axis + 2) % 3] = place(j);
          ray.direction[axis] = sign;
        }
  return rays;
}

double axis_parallel_distance(const EdgeRay& ray) {
  return ray.direction.x + ray.direction.y + ray.direction.z > 0 ? 0.75 : 1.25;
}

}  // namespace tachylite::test
