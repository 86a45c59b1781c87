#pragma once

#include <string>
#include <vector>

namespace tachylite::bench {

/// Rays a second that are made where they are traced, as the kernel for whole paths does: no ray is read, no hit
/// written. A chain of 32 rays begins with a primary ray and goes on with cosine-distributed bounces, with or without
/// a shadow ray from each vertex to a uniform point of the light; by baked primitives on the device, a lane a pixel,
/// and by a loop with rtcIntersect1 and rtcOccluded1. In turn and by CPU time as RaysResult; making the rays counts,
/// on both sides.
struct BouncesResult {
  std::string scene, rays;
  double mrays = 0, embree_mrays = 0;
  double distance_ratio = 0, seen_ratio = 0;  // of the mean distance and of the light points seen: 1 but for noise
  double ratio() const { return mrays / embree_mrays; }
};

/// `only`: one of tiny_scene_names; empty: all.
std::vector<BouncesResult> bench_bounces(const std::string& only, int repetitions);

}  // namespace tachylite::bench
