#pragma once

// Whether noise explains the difference of two images of one scene.
//
// The null hypothesis: both images have the same expectation in every pixel, up to a relative `tolerance`
// (rounding is no difference). Three tests share the level by Sidak, alpha = 1 - (1 - level)^(1/3) each, and
// each shares its alpha again among channels, blocks or pixels:
//  - means, per channel: t statistic of the sums of the difference over groups of pixels, corrected for
//  skewness
//    (Hall 1992, "On the removal of skewness by transformation", JRSS B 54). Its variance comes from the
//    difference itself, so variance layers that over-estimate (those of Owen-sampled renders do) cost it no
//    power.
//  - blocks, per block and channel: the sum of the difference over the root of the summed variance, against
//    Student's t with (sum v)^2 / sum v^2 degrees of freedom (Satterthwaite 1946, with squared estimates for
//    the fourth moments: too few, never too many). The variance is the larger of the block's own and that
//    which its 3x3 neighbours, scaled to its brightness, suggest: a block that missed a rare bright path must
//    not cry wolf.
//  - pixels: the same with neighbourhoods of 5x5 pixels; rejects when more than kPixelShare of all pixels and
//    channels lie beyond their Sidak limit, as Mitsuba's render tests do.

#include <cstdint>
#include <string>
#include <vector>

namespace tachylite {

struct ZTestOptions {
  double level = 0.01;      // probability of calling equal expectations different
  double tolerance = 1e-3;  // relative difference of a pixel, block or mean that is never called one
  int block = 8;            // edge of a block [pixels]
};

/// Variance of the difference of two images, for each channel and pixel.
struct DifferenceVariance {
  std::vector<std::vector<float>> channels;
  bool exact = false;  // known, rather than estimated from the few samples of the images themselves
  /// One image's variance is not known: the scatter of the difference within each block is taken where it is larger.
  bool partial = false;
  std::string from;    // what it was made of, for people
};

/// Relative figures are in units of the channel's mean of b, or of 5 % of the brightest channel's if that is
/// more.
struct MeanTest {
  double difference = 0;      // mean(a - b), relative
  double standard_error = 0;  // of `difference`
  double p = 1;
  double detectable = 0;  // bias that is called a difference with probability 0.95, relative
};
struct BlockTest {
  int block = 8;
  uint64_t count = 0, beyond = 0;   // blocks times channels; those beyond the Sidak limit
  double worst_t = 0, worst_p = 1;  // of the block that is least likely
  int x = 0, y = 0, channel = 0;    // its first pixel, and its channel
  double difference = 0;            // its sum of a - b over its sum of b
  double detectable = 0;            // relative bias seen with probability 0.95 in the median block
};
struct PixelTest {
  uint64_t count = 0, beyond = 0;  // pixels times channels; those beyond the Sidak limit
  double share() const { return count ? static_cast<double>(beyond) / static_cast<double>(count) : 0.0; }
};
constexpr double kPixelShare = 0.0025;

struct ZTest {
  ZTestOptions options;
  std::string variance_from;
  std::vector<MeanTest> means;  // one a channel
  BlockTest blocks;
  PixelTest pixels;
  bool means_agree = true, blocks_agree = true, pixels_agree = true;
  bool agree() const { return means_agree && blocks_agree && pixels_agree; }
};

/// Channels a[c] and b[c] of width*height pixels; all values finite. A pixel that must not count has a = b =
/// 0 and variance 0.
ZTest z_test(int width, int height, const std::vector<std::vector<float>>& a,
             const std::vector<std::vector<float>>& b, const DifferenceVariance& variance,
             const ZTestOptions& options = {});

}  // namespace tachylite
