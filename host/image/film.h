#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "image/image.h"

namespace tachylite {

/// Sums of samples in double, pixel by pixel, in blocks of a few samples: what a render has so far.
/// A block is a run of consecutive samples of a pixel; blocks are added in order of sample index.
class FilmBuffer {
 public:
  FilmBuffer(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  uint64_t samples() const { return samples_; }  // per pixel, of all finished blocks

  /// Adds to pixel `index` (row-major) a block whose `n` samples sum to `sum`.
  void add_block(size_t index, const glm::dvec3& sum, uint64_t n) {
    sum_[index] += sum;
    square_[index] += sum * sum / static_cast<double>(n);
  }
  /// Extra channels (AOVs): sums of samples in double, no variance. count_name: of one more with the number of samples;
  /// empty: none.
  void set_extra_channels(std::vector<std::string> names, std::string count_name = "");
  void add_extra(size_t index, size_t channel, double sum) { extra_[channel][index] += sum; }

  /// To be called after each block has been added to every pixel.
  void finish_block(uint64_t n) {
    samples_ += n;
    ++blocks_;
  }

  glm::dvec3 mean(size_t index) const { return sum_[index] / static_cast<double>(samples_); }
  /// Variance of the mean from the scatter of the block means: (sum s_b^2/n_b - S^2/N) / (B - 1) / N. Unbiased for
  /// independent samples; for stratified ones (Owen-scrambled nets) an over-estimate. 0 with fewer than two blocks.
  glm::dvec3 variance_of_mean(size_t index) const;
  bool has_variance() const { return blocks_ >= 2; }

  /// Estimated relative standard error of the mean pixel: sqrt(mean variance) / mean, of luminance. 0 if unknown.
  double relative_error() const;

  /// R G B and, with two blocks or more, variance.R/G/B; then the extra channels.
  Image to_image() const;

 private:
  int width_, height_;
  uint64_t samples_ = 0, blocks_ = 0;
  std::vector<glm::dvec3> sum_, square_;
  std::vector<std::string> extra_names_;
  std::string count_name_;
  std::vector<std::vector<double>> extra_;
};

}  // namespace tachylite
