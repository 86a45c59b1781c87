#include "pack/envmap_distribution.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.h"
#include "base/parallel.h"
#include "base/pi.h"

namespace tachylite {
namespace {

/// Less than this part of the light above the mean: the map is as good as constant, and sampling it is of no use.
constexpr double kWorthwhile = 1e-3;

uint32_t levels_of(size_t count) {
  uint32_t levels = 0;
  while ((count - 1) >> (2 * levels) != 0) ++levels;
  return levels;
}

size_t table_size(size_t count) {
  size_t size = 0;
  for (uint32_t level = 1; level <= levels_of(count); ++level)
    size += (count + (size_t{1} << (2 * level)) - 1) >> (2 * level);
  return size;
}

/// Writes the table over `weights` (consumed), table_size() rows.
void write_table(std::vector<double> weights, glm::vec4* table) {
  const size_t count = weights.size();
  std::vector<size_t> first(levels_of(count) + 1);  // row at which each level begins
  size_t row = 0;
  for (uint32_t level = levels_of(count); level > 0; --level) {
    first[level] = row;
    row += (count + (size_t{1} << (2 * level)) - 1) >> (2 * level);
  }
  for (uint32_t level = 1; level <= levels_of(count); ++level) {
    std::vector<double> sums((weights.size() + 3) / 4);
    for (size_t i = 0; i < sums.size(); ++i) {
      double running[4], sum = 0;
      for (size_t j = 0; j < 4; ++j) running[j] = sum += 4 * i + j < weights.size() ? weights[4 * i + j] : 0;
      sums[i] = sum;
      // With nothing below, the row is never reached.
      const double scale = sum > 0 ? sum : 1;
      table[first[level] + i] = glm::vec4(running[0] / scale, running[1] / scale, running[2] / scale, 1);
    }
    weights = std::move(sums);
  }
}

}  // namespace

EnvironmentTables build_environment(std::span<const glm::vec3> radiance, uint32_t width, uint32_t height,
                                    bool compensate) {
  CHECK_EQ(radiance.size(), size_t{width} * height);
  EnvironmentTables out;
  out.width = width;
  out.height = std::max(height, 2u);
  out.texels.reserve(size_t{width} * out.height);
  for (const glm::vec3& c : radiance) out.texels.emplace_back(c, 0.0f);
  if (height == 1)
    for (const glm::vec3& c : radiance) out.texels.emplace_back(c, 0.0f);

  // Latitudes, and the solid angle that a texel's tent covers in each row: half the width of its two halves in
  // cos(theta) = 1 - 2 sin^2(theta / 2), times the tent's 2 pi / width in phi.
  const size_t rows = out.height, columns = out.width;
  std::vector<double> tent(rows);
  for (size_t k = 0; k < rows; ++k) {
    const auto half_angle = [&](size_t y) { return 0.5 * kPi * static_cast<double>(y) / static_cast<double>(rows - 1); };
    const bool south = 2 * k > rows - 1;
    const auto latitude = [&](size_t y) {
      const double a = half_angle(y), s = south ? std::cos(a) : std::sin(a);
      return s * s;
    };
    const double above = latitude(k == 0 ? 0 : k - 1), below = latitude(std::min(k + 1, rows - 1)), here = latitude(k);
    out.cdf.emplace_back(k == 0 ? here : above, here, k == rows - 1 ? here : below, south ? 1.0 : 0.0);
    tent[k] = (std::abs(here - above) + std::abs(below - here)) * 2 * kPi / static_cast<double>(columns);
  }

  const auto value = [&](size_t y, size_t x) {
    const glm::vec4& c = out.texels[y * columns + x];
    return (std::max(double{c.x}, 0.0) + std::max(double{c.y}, 0.0) + std::max(double{c.z}, 0.0)) / 3;
  };
  double total = 0;
  for (size_t y = 0; y < rows; ++y) {
    double sum = 0;
    for (size_t x = 0; x < columns; ++x) sum += value(y, x);
    total += sum * tent[y];
  }
  out.mean = total / (4 * kPi);

  const double subtracted = compensate ? out.mean : 0;
  std::vector<double> row_weights(rows);
  double sampled = 0;
  for (size_t y = 0; y < rows; ++y) {
    double sum = 0;
    for (size_t x = 0; x < columns; ++x) sum += std::max(value(y, x) - subtracted, 0.0);
    sampled += row_weights[y] = sum * tent[y];
  }
  out.sampled_mean = sampled > kWorthwhile * total ? sampled / (4 * kPi) : 0;

  out.levels_x = levels_of(columns);
  out.levels_y = levels_of(rows);
  const size_t row_table = table_size(columns), first = rows + table_size(rows);
  out.cdf.resize(first + rows * row_table, glm::vec4(0));
  if (out.sampled_mean == 0) return out;
  write_table(row_weights, &out.cdf[rows]);
  parallel_for(0, rows, 16, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y) {
      std::vector<double> weights(columns);
      for (size_t x = 0; x < columns; ++x) {
        weights[x] = std::max(value(y, x) - subtracted, 0.0);
        out.texels[y * columns + x].w = static_cast<float>(weights[x] / sampled);
      }
      if (row_table > 0) write_table(std::move(weights), &out.cdf[first + y * row_table]);
    }
  });
  return out;
}

}  // namespace tachylite
