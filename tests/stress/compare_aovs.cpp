#include "stress/compare_aovs.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/check.h"

namespace tachylite::test {
namespace {

constexpr int kBlock = 8;
constexpr double kErrors = 8, kTolerance = 1e-4;
constexpr const char* kMoment = "m2_";

struct Window {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Of the means of a window over replicates.
struct Mean {
  double value = 0, variance = 0;
};
Mean mean_of(const AovReplicates& images, const std::string& name, const Window& w) {
  std::array<double, kAovReplicates> means{};
  Mean mean;
  for (size_t i = 0; i < images.size(); ++i) {
    const std::vector<float>* channel = images[i].find(name);
    CHECK(channel != nullptr);
    for (int y = w.y; y < w.y + w.height; ++y)
      for (int x = w.x; x < w.x + w.width; ++x)
        means[i] += double{(*channel)[static_cast<size_t>(y * images[i].width + x)]} / (w.width * w.height);
    mean.value += means[i] / kAovReplicates;
  }
  for (const double m : means)
    mean.variance += (m - mean.value) * (m - mean.value) / (kAovReplicates * (kAovReplicates - 1));
  return mean;
}

bool is_auxiliary(const std::string& name) {
  return name != "R" && name != "G" && name != "B" && !name.starts_with("variance.");
}

size_t moment_channel(const FilmBuffer& film, int color) {
  const std::vector<std::string>& names = film.extra_channels();
  const auto found = std::find(names.begin(), names.end(), kMoment + std::string(1, "RGB"[color]));
  CHECK(found != names.end());
  return static_cast<size_t>(found - names.begin());
}

/// Of all channels that begin so: a component of a vector may be nothing but rounding.
double largest_of(const Image& image, const std::string& prefix) {
  double largest = 0;
  for (size_t c = 0; c < image.names.size(); ++c)
    if (image.names[c].starts_with(prefix))
      for (const float value : image.channels[c]) largest = std::max(largest, std::abs(double{value}));
  return largest;
}

}  // namespace

std::string compare_aovs(const AovReplicates& a, const AovReplicates& b) {
  const int width = a[0].width, height = a[0].height;
  std::vector<Window> windows = {{0, 0, width, height}};
  for (int y = 0; y < height; y += kBlock)
    for (int x = 0; x < width; x += kBlock)
      windows.push_back({x, y, std::min(kBlock, width - x), std::min(kBlock, height - y)});
  std::string message;
  double worst = kErrors;
  for (size_t c = 0; c < a[0].names.size(); ++c) {
    const std::string& name = a[0].names[c];
    if (!is_auxiliary(name)) continue;
    const bool moment = name.starts_with(kMoment);
    const double largest = largest_of(a[0], moment ? kMoment : name.substr(0, name.find('.') + 1));
    for (const Window& w : windows) {
      const Mean here = mean_of(a, name, w), there = mean_of(b, name, w);
      const double beyond = std::abs(here.value - there.value) - kTolerance * largest;
      const double error = std::sqrt(here.variance + there.variance);
      if (!(beyond > worst * error)) continue;
      worst = error > 0 ? beyond / error : INFINITY;
      message = fmt::format("{} differs by {:.1f} standard errors from pixel {}, {} on, over {} x {}: {:.6g} on the "
                            "device, {:.6g} by the reference", name, worst, w.x, w.y, w.width, w.height, here.value,
                            there.value);
    }
  }
  return message;
}

std::string check_moments(const std::function<FilmBuffer(uint64_t samples)>& render) {
  constexpr uint64_t kSamples = 6;  // more than the block of four that a device sums in float32
  constexpr double kRounding = 1e-5;
  std::vector<FilmBuffer> films;
  for (uint64_t n = 1; n <= kSamples; ++n) films.push_back(render(n));
  const FilmBuffer& all = films.back();
  std::string message;
  double worst = kRounding;
  for (size_t i = 0; i < all.pixels(); ++i)
    for (int c = 0; c < 3; ++c) {
      double sum = 0, squares = 0;
      for (const FilmBuffer& film : films) {
        const double to_here = film.mean(i)[c] * static_cast<double>(film.samples());
        squares += (to_here - sum) * (to_here - sum);
        sum = to_here;
      }
      const double found = all.extra_mean(i, moment_channel(all, c)), expected = squares / double{kSamples};
      const double error = std::abs(found - expected) / std::max(sum * sum, 1e-30);
      if (!(error > worst)) continue;
      worst = error;
      message = fmt::format("the second moment of channel {} of pixel {} is {:.8g}, not {:.8g}", c, i, found, expected);
    }
  return message;
}

}  // namespace tachylite::test
