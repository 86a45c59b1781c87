#pragma once

// How far apart two images of one scene are, and, where their variance is known, whether noise explains it.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "image/z_test.h"

namespace tachylite {

struct ChannelDifference {
  std::string name;
  double mean_a = 0, mean_b = 0;
  double ratio = 1;  // mean_a / mean_b; 1 when both are 0
  double mse = 0, rel_mse = 0;
  double largest = 0;  // largest |a - b|, at pixel (x, y)
  int x = 0, y = 0;
};

struct Comparison {
  int width = 0, height = 0;
  std::vector<ChannelDifference> channels;
  double mse = 0, rel_mse = 0;  // means over channels
  double epsilon = 0;           // relMSE = mean((a - b)^2 / (b^2 + epsilon)), epsilon = 0.01 (mean of b)^2
  uint64_t nonfinite = 0;       // values that are not finite, in either image: left out of all figures
  std::optional<ZTest> test;
  bool agree() const { return nonfinite == 0 && (!test || test->agree()); }
};

/// From the layers variance.R/G/B (variance of the pixel's mean) of the two; nothing if neither has them. Of an
/// image without them only the scatter of the difference within blocks is known.
std::optional<DifferenceVariance> layer_variance(const Image& a, const Image& b);

/// From an image R G B of the variance of one sample, for an image of `samples` of them a pixel. Below 1e-4
/// it counts as 1e-4, as in Mitsuba's render tests: so dark a pixel's variance is rarely known well.
DifferenceVariance sample_variance(const Image& variance, uint64_t samples);

/// Compares the channels R G B (or Y) of `a` with those of `b`. Throws InputError when sizes or channels do
/// not fit.
Comparison compare_images(const Image& a, const Image& b, const std::optional<DifferenceVariance>& variance,
                          const ZTestOptions& options = {});

/// The figures and the verdict, a line each.
std::string describe(const Comparison& comparison);
std::string describe(const ZTest& test, const std::vector<std::string>& channel_names);

}  // namespace tachylite
