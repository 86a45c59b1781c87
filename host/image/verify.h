#pragma once

// Do two renderers agree? Both render more and more samples until z_test has the power to see a bias of given
// size; then its verdict counts. Level of the whole: a difference found at the level of z_test must be found
// again in a second, independent pair of images of as many samples (0.01^2 = 1e-4); before the power is
// reached only differences at kEarlyLevel end it.

#include <cstdint>
#include <functional>

#include "image/compare.h"

namespace tachylite {

struct VerifyOptions {
  double mean_bias = 0.01;   // relative bias of the mean, in every channel, to be seen with probability 0.95
  double block_bias = 0.10;  // the same of the median block
  uint64_t first_samples = 16, most_samples = uint64_t{1} << 20;  // per pixel
  ZTestOptions test;  // `block` is enlarged so that there are at most about 1024 blocks
};
constexpr double kEarlyLevel = 1e-6;

/// Renders `samples` for each pixel, independent of those of all other rounds. Returns R G B and
/// variance.R/G/B; nothing when interrupted or out of time, which ends it all without a verdict.
using RenderRound = std::function<std::optional<Image>(uint64_t samples, int round)>;

struct Verification {
  enum class Verdict { kAgree, kDiffer, kOpen };
  Verdict verdict = Verdict::kOpen;
  uint64_t samples = 0;    // per pixel, of each renderer
  Comparison comparison;   // A: `tested`, B: `judge`; the last one made
  bool confirmed = false;  // the verdict is of the second pair
};

/// `report` is called after each comparison.
Verification verify(const RenderRound& tested, const RenderRound& judge, const VerifyOptions& options,
                    const std::function<void(const Verification&)>& report = {});

/// The mean of two images of independent samples, weighted with their numbers: channels R G B, and their
/// variances.
Image combine_estimates(const Image& a, uint64_t samples_a, const Image& b, uint64_t samples_b);

}  // namespace tachylite
