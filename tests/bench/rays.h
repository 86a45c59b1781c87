#pragma once

#include <string>
#include <vector>

namespace tachylite::bench {

/// Rays a second of the device's trace kernels and of Embree on the same rays, which lie in memory, as hits do. Both
/// run in turn in this process, and each figure is that of the repetition with least CPU time: 2 * rays / CPU
/// seconds, what 2 undisturbed cores do.
struct RaysResult {
  std::string scene, rays;
  double mrays = 0, embree_mrays = 0;
  size_t mismatches = 0;  // rays of which one sees a hit and the other none, or whose t differ by more than 1e-4 of it
  double ratio() const { return mrays / embree_mrays; }
};

/// By the scene's tree. `only`: one scene; empty: all.
std::vector<RaysResult> bench_rays(const std::string& only, int repetitions);
/// By baked primitives (shaders/geometry/baked.glsl), in vectors as wide as renders have for them. `only`: one of
/// tiny_scene_names(); empty: all.
std::vector<RaysResult> bench_baked_rays(const std::string& only, int repetitions);

}  // namespace tachylite::bench
