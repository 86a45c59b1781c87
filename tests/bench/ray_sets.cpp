#include "bench/ray_sets.h"

#include <limits>

#include "support/pcg32.h"

namespace tachylite::bench {
namespace {

using test::Pcg32;
using test::TraceRay;

std::vector<TraceRay> make_primary(const Camera& camera) {
  const glm::vec3 forward = glm::normalize(camera.target - camera.eye);
  const glm::vec3 right = glm::normalize(glm::cross(forward, {0, 0, 1})), up = glm::cross(right, forward);
  const float half = glm::tan(glm::radians(0.5f * camera.fov_degrees));
  const float scale = 2 * half / static_cast<float>(camera.resolution);
  constexpr uint32_t kTile = 8;
  const uint32_t tiles = camera.resolution / kTile;
  std::vector<TraceRay> rays;
  for (uint32_t i = 0; i < camera.resolution * camera.resolution; ++i) {
    const uint32_t tile = i / (kTile * kTile), pixel = i % (kTile * kTile);
    const auto x = static_cast<float>(tile % tiles * kTile + pixel % kTile) + 0.5f;
    const auto y = static_cast<float>(tile / tiles * kTile + pixel / kTile) + 0.5f;
    const glm::vec3 direction = forward + (x * scale - half) * right + (half - y * scale) * up;
    rays.push_back({camera.eye, std::numeric_limits<float>::infinity(), glm::normalize(direction), gpu::kNoHit});
  }
  return rays;
}

}  // namespace

std::vector<RaySet> make_ray_sets(const BenchScene& scene, const EmbreeScene& embree) {
  std::vector<RaySet> sets{{"primary", false, true, make_primary(scene.camera)},
                           {"diffuse", false, false, {}},
                           {"shuffled", false, false, {}},
                           {"shadow", true, false, {}}};
  const std::vector<TraceRay>& primary = sets[0].rays;
  std::vector<test::TraceHit> hits(primary.size());
  embree.closest(primary, hits, 2);

  Pcg32 random(2);
  for (size_t i = 0; i < primary.size(); ++i) {
    if (hits[i].id == gpu::kNoHit) continue;
    const glm::uvec3& triangle = scene.mesh.triangles[hits[i].id];
    const glm::vec3& v0 = scene.mesh.vertices[triangle.x];
    glm::vec3 n = glm::normalize(
        glm::cross(scene.mesh.vertices[triangle.y] - v0, scene.mesh.vertices[triangle.z] - v0));
    if (glm::dot(n, primary[i].direction) > 0) n = -n;
    const glm::vec3 p = primary[i].origin + hits[i].t * primary[i].direction + n * (1e-4f * hits[i].t);
    sets[1].rays.push_back({p, std::numeric_limits<float>::infinity(), random.cosine_direction(n), gpu::kNoHit});
    const float u = random.uniform(), v = random.uniform();
    const glm::vec3 target = scene.light.corner + u * scene.light.edge_u + v * scene.light.edge_v;
    const float distance = glm::length(target - p);
    sets[3].rays.push_back({p, distance * (1 - 1e-4f), (target - p) / distance, gpu::kNoHit});
  }
  sets[2].rays = sets[1].rays;
  for (size_t i = sets[2].rays.size(); i > 1; --i)
    std::swap(sets[2].rays[i - 1], sets[2].rays[random.below(static_cast<uint32_t>(i))]);
  return sets;
}

}  // namespace tachylite::bench
