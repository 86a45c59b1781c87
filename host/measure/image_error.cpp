#include "measure/image_error.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/error.h"

namespace tachylite {
namespace {

constexpr const char* kColor[] = {"R", "G", "B"};
constexpr size_t kBlock = 16;

size_t pixels_of(const Image& image) {
  return static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
}

/// Sums over blocks of body(channel, pixel) / (R^2 + epsilon).
template <class Body>
std::vector<double> block_sums(const ErrorScale& scale, const Body& body) {
  const auto width = static_cast<size_t>(scale.image().width), height = static_cast<size_t>(scale.image().height);
  const size_t across = (width + kBlock - 1) / kBlock;
  std::vector<double> sums(across * ((height + kBlock - 1) / kBlock), 0.0);
  const double share = 1 / static_cast<double>(3 * width * height);
  for (size_t c = 0; c < 3; ++c)
    for (size_t y = 0; y < height; ++y)
      for (size_t x = 0; x < width; ++x) {
        const size_t pixel = y * width + x;
        sums[y / kBlock * across + x / kBlock] += share * body(c, pixel) / scale.square(c, pixel);
      }
  return sums;
}

double square_difference(const Image& a, const Image& b, size_t channel, size_t pixel) {
  const double d = double{a.channels[channel][pixel]} - double{b.channels[channel][pixel]};
  return d * d;
}

double unbiasing(size_t images) {
  return static_cast<double>(images) / static_cast<double>(images - 1);
}

}  // namespace

ErrorScale::ErrorScale(const Image& image) : image_(color_of(image)) {
  double mean = 0;
  const double share = 1 / static_cast<double>(3 * pixels_of(image_));
  for (const std::vector<float>& channel : image_.channels)
    for (float value : channel) mean += share * value;
  epsilon_ = std::max(0.01 * mean * mean, 1e-30);
}

double ErrorScale::square(size_t channel, size_t pixel) const {
  const double value = image_.channels[channel][pixel];
  return value * value + epsilon_;
}

Image color_of(const Image& image) {
  Image color;
  color.width = image.width;
  color.height = image.height;
  for (const char* name : kColor) {
    const std::vector<float>* channel = image.find(name);
    if (!channel) throw InputError(fmt::format("the image has no channel {}", name));
    color.add(name) = *channel;
  }
  return color;
}

Image mean_of(std::span<const Image> images) {
  CHECK(!images.empty());
  Image mean = images[0];
  for (size_t c = 0; c < mean.channels.size(); ++c)
    for (size_t i = 0; i < mean.channels[c].size(); ++i) {
      double sum = 0;
      for (const Image& image : images) sum += image.channels[c][i];
      mean.channels[c][i] = static_cast<float>(sum / static_cast<double>(images.size()));
    }
  return mean;
}

std::vector<std::vector<double>> deviations(std::span<const Image> images, const ErrorScale& scale) {
  CHECK_LE(size_t{2}, images.size());
  const double factor = unbiasing(images.size());
  const Image mean = mean_of(images);
  std::vector<std::vector<double>> errors;
  for (const Image& image : images)
    errors.push_back(block_sums(
        scale, [&](size_t c, size_t pixel) { return factor * square_difference(image, mean, c, pixel); }));
  return errors;
}

std::vector<std::vector<double>> errors_against(std::span<const Image> images, const Image& reference,
                                                const ErrorScale& scale) {
  const Image target = color_of(reference);
  const std::vector<float>* noise[3];
  for (size_t c = 0; c < 3; ++c) noise[c] = reference.find(std::string("variance.") + kColor[c]);
  std::vector<std::vector<double>> errors;
  for (const Image& image : images)
    errors.push_back(block_sums(scale, [&](size_t c, size_t pixel) {
      return square_difference(image, target, c, pixel) - (noise[c] ? double{(*noise[c])[pixel]} : 0.0);
    }));
  return errors;
}

std::vector<float> error_map(std::span<const Image> images, const Image& target, const ErrorScale& scale,
                             bool unbiased) {
  const double share = (unbiased ? unbiasing(images.size()) : 1) / static_cast<double>(3 * images.size());
  std::vector<float> map(pixels_of(target));
  for (size_t pixel = 0; pixel < map.size(); ++pixel) {
    double sum = 0;
    for (const Image& image : images)
      for (size_t c = 0; c < 3; ++c) sum += square_difference(image, target, c, pixel) / scale.square(c, pixel);
    map[pixel] = static_cast<float>(std::sqrt(share * sum));
  }
  return map;
}

}  // namespace tachylite
