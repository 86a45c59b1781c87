#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/film.h"

namespace tachylite {

// Adaptive sampling without bias. All pixels have some samples first (the pilot). What each pixel gets beyond them is
// decided once, by the pilot of other pixels: the image is a checkerboard, and the black pixels decide for the white
// ones, the white for the black, with a budget for each colour. Samples of different pixels are independent, so that
// the number of a pixel's samples does not depend on their values, and its mean stays what it was. (That a pixel's own
// samples decide when it has enough is biased: those that have missed a rare bright path stop early. Kirk and Arvo
// 1991, "Unbiased Sampling Techniques for Image Synthesis".)

/// Samples that serve as pilot where `samples` a pixel are wanted: a quarter, as a power of two, but at least kLeastPilot.
constexpr uint64_t kLeastPilot = 16;
uint64_t pilot_samples(uint64_t samples);

/// Relative numbers of samples that make the relative squared error of the image least for its budget: proportional to
/// the standard deviation of a sample over the pixel's value. Here the root of the mean of var / (mean^2 + 0.01 (image
/// mean)^2), summed over channels, over those of the 7 x 7 pixels around that have the other colour. The film must have
/// variances.
std::vector<float> sampling_density(const FilmBuffer& pilot);

constexpr uint32_t kLargestShare = 8;
/// Blocks of samples of each pixel, `mean` of them on average for either colour of the checkerboard: `least` (the
/// pilot) and a multiple of `chunk` more; in proportion to `density` where that is more than `least`, but at most
/// kLargestShare times the mean. Rounded up or down by a pattern that depends on the pixel's place alone.
std::vector<uint32_t> allocate_blocks(std::span<const float> density, int width, uint32_t least, double mean,
                                      uint32_t chunk);

}  // namespace tachylite
