#include "wavefront/adaptive_sampling.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"

namespace tachylite {
namespace {

constexpr int kRadius = 3;  // of the window that decides for a pixel

bool is_black(int x, int y) { return (x + y) % 2 == 0; }

/// Relative variance of a sample, times a constant; pixels of one colour know nothing of those of the other.
std::vector<float> relative_variances(const FilmBuffer& film) {
  const auto width = static_cast<size_t>(film.width());
  const auto colour = [&](size_t i) { return is_black(static_cast<int>(i % width), static_cast<int>(i / width)) ? 0 : 1; };
  glm::dvec3 sums[2] = {};
  double counts[2] = {};
  for (size_t i = 0; i < film.pixels(); ++i) {
    sums[colour(i)] += film.mean(i);
    ++counts[colour(i)];
  }
  double epsilons[2];
  for (int c = 0; c < 2; ++c) epsilons[c] = std::max(0.01 / 3 * glm::dot(sums[c], sums[c]) / (counts[c] * counts[c]), 1e-300);
  std::vector<float> variances(film.pixels());
  parallel_for(0, variances.size(), 4096, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const glm::dvec3 mean = film.mean(i), relative = film.variance_of_mean(i) / (mean * mean + epsilons[colour(i)]);
      variances[i] = static_cast<float>(relative.x + relative.y + relative.z);
    }
  });
  return variances;
}

}  // namespace

uint64_t pilot_samples(uint64_t samples) { return std::min(samples, std::max(std::bit_floor(samples / 4), kLeastPilot)); }

std::vector<float> sampling_density(const FilmBuffer& pilot) {
  CHECK(pilot.has_variance());
  const std::vector<float> variances = relative_variances(pilot);
  const int width = pilot.width(), height = pilot.height();
  std::vector<float> density(variances.size());
  parallel_for(0, static_cast<size_t>(height), 16, [&](size_t first, size_t last) {
    for (int y = static_cast<int>(first); y < static_cast<int>(last); ++y)
      for (int x = 0; x < width; ++x) {
        double sum = 0, count = 0;
        for (int v = std::max(y - kRadius, 0); v <= std::min(y + kRadius, height - 1); ++v)
          for (int u = std::max(x - kRadius, 0); u <= std::min(x + kRadius, width - 1); ++u)
            if (is_black(u, v) != is_black(x, y)) {
              sum += variances[static_cast<size_t>(v * width + u)];
              ++count;
            }
        density[static_cast<size_t>(y * width + x)] = static_cast<float>(count > 0 ? std::sqrt(sum / count) : 0);
      }
  });
  return density;
}

std::vector<uint32_t> allocate_blocks(std::span<const float> density, int width, uint32_t least, double mean,
                                      uint32_t chunk) {
  std::vector<uint32_t> blocks(density.size(), least);
  const auto floor = static_cast<double>(least);
  for (const bool black : {true, false}) {
    std::vector<size_t> pixels;
    for (size_t i = 0; i < density.size(); ++i) {
      const int x = static_cast<int>(i % static_cast<size_t>(width)), y = static_cast<int>(i / static_cast<size_t>(width));
      if (is_black(x, y) == black) pixels.push_back(i);
    }
    double total = 0;
    for (const size_t i : pixels) total += density[i];
    if (pixels.empty()) continue;
    const double average = total / static_cast<double>(pixels.size());
    const auto wanted = [&](size_t i, double scale) {
      // Where nothing is known to vary, all alike.
      const double share = average > 0 ? density[i] / average : 1;
      return std::clamp(scale * share, floor, std::max(kLargestShare * mean, floor));
    };
    double low = 0, high = 1;
    const auto mean_of = [&](double scale) {
      double sum = 0;
      for (const size_t i : pixels) sum += wanted(i, scale);
      return sum / static_cast<double>(pixels.size());
    };
    while (mean_of(high) < mean && high < 1e12) high *= 2;
    for (int step = 0; step < 40; ++step) {
      const double middle = (low + high) / 2;
      (mean_of(middle) < mean ? low : high) = middle;
    }
    for (const size_t i : pixels) {
      // The golden ratio's multiples round neighbours to either side in turn.
      const double pattern = std::fmod(0.6180339887498949 * static_cast<double>(i), 1.0);
      blocks[i] += chunk * static_cast<uint32_t>(std::floor((wanted(i, high) - floor) / chunk + pattern));
    }
  }
  return blocks;
}

}  // namespace tachylite
