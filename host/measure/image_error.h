#pragma once

#include <span>
#include <vector>

#include "image/image.h"

namespace tachylite {

/// What relative errors are relative to: R^2 + epsilon in each pixel and channel, epsilon = 0.01 (mean of R)^2, as
/// `tachylite compare` does.
class ErrorScale {
 public:
  /// Of the channels R G B.
  explicit ErrorScale(const Image& image);
  double epsilon() const { return epsilon_; }
  const Image& image() const { return image_; }
  double square(size_t channel, size_t pixel) const;  // R^2 + epsilon

 private:
  Image image_;
  double epsilon_ = 0;
};

/// The channels R G B alone; others, and metadata, are dropped. Throws InputError where one is missing.
Image color_of(const Image& image);
/// The mean of images of one size.
Image mean_of(std::span<const Image> images);

/// Errors of the images of one sample count that differ in seed: [image][block of 16 x 16 pixels], each the sum over
/// the block of squared relative errors over the pixels and channels of the whole image. An image's relMSE is the sum
/// over its blocks.
/// Without a reference an image's squared error is K / (K - 1) (I - mean of all K)^2: its mean over the images is the
/// variance, the same as (a - b)^2 / 2 over all pairs, and unbiased.
std::vector<std::vector<double>> deviations(std::span<const Image> images, const ErrorScale& scale);
/// Against a reference; what its own noise (variance.* layers, where it has them) adds is taken off.
std::vector<std::vector<double>> errors_against(std::span<const Image> images, const Image& reference,
                                                const ErrorScale& scale);

/// Root of the relative squared error of each pixel, mean over images and channels, against `target`; with
/// `unbiased` times K / (K - 1).
std::vector<float> error_map(std::span<const Image> images, const Image& target, const ErrorScale& scale, bool unbiased);

}  // namespace tachylite
