#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "measure/measurement.h"

namespace tachylite {

/// A renderer under measurement: its name, and how it renders.
struct Contestant {
  std::string name;
  std::function<TimedImage(uint64_t samples, uint32_t seed)> render;
  uint64_t most_samples = 0;  // levels beyond are left out; 0: none
};

struct MeasureOptions {
  uint64_t least_samples = 4, most_samples = 256;  // a pixel; doubled from the least on
  uint32_t first_seed = 1;
  int seeds = 5;
  bool cpu_clock = true;  // seconds = CPU seconds / cores, else wall-clock seconds
  int cores = 1;
  /// Called before each image: what is rendered, and the fraction of all samples that is done.
  std::function<void(const std::string& what, double fraction)> progress;
};

/// Numbers of samples from the least to the most, doubling.
std::vector<uint64_t> sample_levels(const MeasureOptions& options);

/// Renders every level with every seed by all contestants in turn, so that a busy machine disturbs them alike, from
/// the most samples down to the least. Errors are against `reference` where it is not null, else from seed pairs,
/// relative to the mean of the first contestant's images of the most samples. Fills the result's measurements and
/// pictures. Throws InputError when an image does not have the size of the others, or of the reference.
void measure_scene(SceneMeasurement& result, std::span<const Contestant> contestants, const Image* reference,
                   const MeasureOptions& options);

}  // namespace tachylite
