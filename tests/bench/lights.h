#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tachylite::bench {

/// One sample of direct light a path, in a field of emissive triangles whose powers span four decades; few are near.
struct LightsResult {
  uint32_t lights = 0;
  double ns_per_path = 0;           // CPU time of all cores, of a camera ray, a light sample and its shadow ray
  double uniform_ns_per_path = 0;   // at least what choosing uniformly takes: that of the same triangles, one of which shines
  double relative_variance = 0;     // of one sample of a pixel
  double uniform_variance = 0;      // the same when lights are chosen uniformly
  double equal_time_gain() const {
    return uniform_variance * uniform_ns_per_path / (relative_variance * ns_per_path);
  }
};
/// At 1, 10, 1000, 100,000 and, if `large`, 1,000,000 triangles.
std::vector<LightsResult> bench_lights(bool large, int repetitions);

/// A floor and a ball under a sky with a sun of 1e5 times its radiance in one texel of 512 x 256, at 16 samples:
/// variance over squared mean of the pixels, and CPU time.
struct SunResult {
  std::string sampling;  // mis, emitter, bsdf
  double relative_variance = 0, ns_per_path = 0;
};
std::vector<SunResult> bench_sun(int repetitions);

}  // namespace tachylite::bench
