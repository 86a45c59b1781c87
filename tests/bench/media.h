#pragma once

#include <string>
#include <vector>

namespace tachylite::bench {

/// Two ways of sampling the same scene, by their error at as many samples: relMSE = mean over pixels and channels of
/// variance / (mean^2 + 1e-3 of the image's mean^2), from independent replicates, so without a reference.
struct MediumGain {
  std::string scene;
  double ours = 0, yardstick = 0;            // relMSE
  double ours_largest = 0, yardstick_largest = 0;  // largest pixel of one replicate, in units of the image's mean
  double mean_ratio = 0;                     // of the images' means: 1 but for noise
  double seconds_ratio = 0;                  // CPU seconds, ours to the yardstick's
};
/// Point light in thin fog: samples along segments against samples at collisions. A sparse grid: majorants of cells against
/// one of the whole, whose gain is time. Coloured media: channels in
/// proportion to the throughput against uniform ones, both with the density mixed over the channels.
std::vector<MediumGain> bench_medium_gains(int replicates);

/// Seconds on the device of each kernel for one collision in a homogeneous medium, by timestamp queries.
struct MediumCost {
  std::string kernel;
  double ns_per_event = 0;
};
std::vector<MediumCost> bench_medium_costs();

}  // namespace tachylite::bench
