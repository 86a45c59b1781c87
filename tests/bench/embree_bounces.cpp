#include "bench/embree_bounces.h"

#include <limits>
#include <mutex>

#include "support/pcg32.h"

namespace tachylite::bench {
namespace {

using glm::vec3;

constexpr float kOffset = 1e-4f;  // as in bounce_baked.comp

}  // namespace

EmbreeBounces::EmbreeBounces(const BenchScene& scene, const EmbreeScene& embree)
    : embree_(embree), light_(scene.light) {
  const auto& vertices = scene.mesh.vertices;
  for (const glm::uvec3& t : scene.mesh.triangles)
    normals_.push_back(glm::normalize(glm::cross(vertices[t.y] - vertices[t.x], vertices[t.z] - vertices[t.x])));
}

BounceSums EmbreeBounces::trace(std::span<const test::TraceRay> primary, uint32_t bounces, bool shadow,
                                int threads) const {
  BounceSums total;
  std::mutex mutex;
  for_blocks(primary.size(), threads, [&](size_t first, size_t last) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    test::Pcg32 random(first);
    BounceSums sums;
    for (size_t i = first; i < last; ++i) {
      test::TraceRay ray = primary[i];
      for (uint32_t k = 0; k < bounces; ++k) {
        RTCRayHit query{};
        query.ray = to_embree(ray);
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(embree_.handle(), &context, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
          ray = primary[i];
          continue;
        }
        const float t = query.ray.tfar;
        sums.distances += t;
        vec3 n = normals_[query.hit.primID];
        if (glm::dot(n, ray.direction) > 0) n = -n;
        const vec3 p = ray.origin + t * ray.direction + kOffset * n;
        if (shadow) {
          const vec3 target = light_.corner + random.uniform() * light_.edge_u + random.uniform() * light_.edge_v;
          RTCRay to_light = to_embree({p, 1 - kOffset, target - p});
          rtcOccluded1(embree_.handle(), &context, &to_light);
          sums.seen += to_light.tfar >= 0;
        }
        ray = {p, std::numeric_limits<float>::infinity(), random.cosine_direction(n)};
      }
    }
    const std::lock_guard lock(mutex);
    total.distances += sums.distances;
    total.seen += sums.seen;
  });
  return total;
}

}  // namespace tachylite::bench
