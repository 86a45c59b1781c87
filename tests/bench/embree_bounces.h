#pragma once

#include "bench/embree_scene.h"
#include "bench/scenes.h"

namespace tachylite::bench {

/// Sums over all vertices of bounces.
struct BounceSums {
  double distances = 0;  // of their rays
  double seen = 0;       // light points
};

/// Bounces from the primary rays as bench/bounce_baked.comp makes them, by other random numbers: one ray at a time,
/// rtcIntersect1 and rtcOccluded1.
class EmbreeBounces {
 public:
  EmbreeBounces(const BenchScene& scene, const EmbreeScene& embree);
  BounceSums trace(std::span<const test::TraceRay> primary, uint32_t bounces, bool shadow, int threads) const;

 private:
  const EmbreeScene& embree_;
  RectangleLight light_;
  std::vector<glm::vec3> normals_;  // of triangles
};

}  // namespace tachylite::bench
