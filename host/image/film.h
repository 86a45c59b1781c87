#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "image/image.h"
#include "image/reproducible_sums.h"

namespace tachylite {

/// A run of samples of every pixel: [first, first + count).
struct SampleRange {
  uint64_t first = 0, count = 0;
  uint64_t end() const { return first + count; }
  bool operator==(const SampleRange&) const = default;
};

/// Sums of samples, pixel by pixel, in blocks of a few samples: what a render has so far. A block is a run of
/// consecutive samples of a pixel. The sums do not depend on the order of blocks (image/reproducible_sums.h): films of
/// disjoint samples merge into the film of all of them, bit for bit.
class FilmBuffer {
 public:
  /// count_channel: of the image, the number of samples; empty: none.
  FilmBuffer(int width, int height, std::vector<std::string> extra_channels = {}, std::string count_channel = {});

  int width() const { return width_; }
  int height() const { return height_; }
  size_t pixels() const { return static_cast<size_t>(width_) * static_cast<size_t>(height_); }
  uint64_t samples() const;  // that every pixel has: of all finished blocks
  const std::vector<SampleRange>& ranges() const { return ranges_; }  // sorted, not touching
  uint64_t blocks() const { return blocks_; }
  /// Adaptive sampling: whether pixels have blocks of their own; all samples of a pixel; and their mean over the image.
  bool is_adaptive() const { return !own_.empty(); }
  uint64_t samples_of(size_t index) const { return samples() + (is_adaptive() ? own_[index].samples : 0); }
  uint64_t blocks_of(size_t index) const { return blocks_ + (is_adaptive() ? own_[index].blocks : 0); }
  double mean_samples() const;
  const std::vector<std::string>& extra_channels() const { return extra_names_; }

  /// Adds to pixel `index` (row-major) a block whose `n` samples sum to `sum`. Different pixels may be added to by
  /// different threads.
  void add_block(size_t index, const glm::dvec3& sum, uint64_t n) {
    for (glm::length_t c = 0; c < 3; ++c) {
      sums_[static_cast<size_t>(c)].add(index, sum[c]);
      squares_[static_cast<size_t>(c)].add(index, sum[c] * sum[c] / static_cast<double>(n));
    }
  }
  /// Adaptive sampling: counts `blocks` blocks of pixel `index` alone, of `samples` samples, that have been added to it.
  /// They are not among ranges(): such a film cannot be merged. Not while other threads read.
  void finish_own_blocks(size_t index, uint64_t blocks, uint64_t samples);
  /// What decides how many own blocks a pixel gets (wavefront/adaptive_sampling.h), kept for who goes on; or empty.
  const std::vector<float>& sampling_density() const { return density_; }
  void set_sampling_density(std::vector<float> density) { density_ = std::move(density); }

  /// Extra channels (AOVs): sums of samples, no variance.
  void add_extra(size_t index, size_t channel, double sum) { extra_[channel].add(index, sum); }

  /// To be called after `blocks` blocks, which are the samples of `range`, have been added to every pixel. The range
  /// is disjoint from those before.
  void finish_blocks(const SampleRange& range, uint64_t blocks = 1);

  /// Adds a film of other samples of the same pixels and channels (their order may differ); together they have at most
  /// ReproducibleSums::kMaxValues blocks.
  void merge(const FilmBuffer& other);

  glm::dvec3 mean(size_t index) const;
  double extra_mean(size_t index, size_t channel) const;
  /// Variance of the mean from the scatter of the block means: (sum s_b^2/n_b - S^2/N) / (B - 1) / N. Unbiased for
  /// independent samples; for stratified ones (Owen-scrambled nets) an over-estimate. 0 with fewer than two blocks.
  glm::dvec3 variance_of_mean(size_t index) const;
  bool has_variance() const { return blocks_ >= 2; }

  /// Estimated relative standard error of the mean pixel: sqrt(mean variance) / mean, of luminance. 0 if unknown.
  /// The channels are taken to err together, as those of a path do: of coloured noise an over-estimate.
  double relative_error() const;

  /// R G B and, with two blocks or more, variance.R/G/B; then the extra channels; of adaptive sampling `samples`. With
  /// `sums` (not of an adaptive film) also all that merging needs: word channels sums.NAME.0 to .3 and squares.NAME.0
  /// to .3, and metadata sample_ranges and blocks.
  Image to_image(bool sums = false) const;
  /// The film that an image with sums was made of. Throws InputError, which begins with the place, where they lack or
  /// are broken.
  static FilmBuffer from_image(const Image& image, const std::string& place);

 private:
  struct NamedSums {
    std::string name;
    ReproducibleSums* sums;
  };
  struct OwnBlocks {
    uint32_t blocks = 0, samples = 0;
  };
  std::vector<NamedSums> all_sums();

  int width_, height_;
  uint64_t blocks_ = 0;
  std::vector<SampleRange> ranges_;
  std::vector<OwnBlocks> own_;  // a pixel each, or empty
  std::vector<float> density_;
  ReproducibleSums sums_[3], squares_[3];
  std::vector<std::string> extra_names_;
  std::vector<ReproducibleSums> extra_;
  std::string count_channel_;
};

/// Layers of an image's word channels that hold a film's sums.
constexpr const char* kSumsLayer = "sums.";
constexpr const char* kSquaresLayer = "squares.";

/// "0-15", "0-15,32-63": first and last sample of each.
std::string format_ranges(const std::vector<SampleRange>& ranges);

}  // namespace tachylite
