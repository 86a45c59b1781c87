#include "image/z_test.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "base/check.h"

namespace tachylite {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPowerQuantile = 1.6448536269514722;  // standard normal, 0.95
constexpr size_t kMinGroups = 64;                      // for the test of the means

/// 1 - (1 - alpha)^(1/n): the level of one of n tests.
double sidak(double alpha, double n) {
  return -std::expm1(std::log1p(-alpha) / n);
}

/// Probability of |T| > |t| for Student's t; infinitely many degrees of freedom are the normal distribution.
double two_sided_p(double t, double dof) {
  t = std::abs(t);
  if (!std::isfinite(t)) return 0;
  if (!std::isfinite(dof)) return std::erfc(t / std::sqrt(2.0));
  return 2 * cdf(complement(boost::math::students_t(dof), t));
}
/// The t that has that two-sided p.
double two_sided_limit(double p, double dof) {
  if (!std::isfinite(dof)) return quantile(complement(boost::math::normal(), p / 2));
  return quantile(complement(boost::math::students_t(dof), p / 2));
}

/// Moves `difference` towards 0 by `tolerance`, at most to 0.
double shrink(double difference, double tolerance) {
  return std::copysign(std::max(0.0, std::abs(difference) - tolerance), difference);
}

/// A sum of variances and its degrees of freedom.
struct Variance {
  double sum = 0, square = 0;  // of v, of v^2
  void add(double v, double v_square) { sum += v, square += v_square; }
  double dof() const { return square > 0 ? sum * sum / square : kInfinity; }
};

/// Sums over a square of pixels.
struct Sums {
  double difference = 0, reference = 0, power = 0;  // of a - b, |b|, b^2
  Variance variance;
  double pixels = 0;
};

/// Sums over the squares of edge `edge` that tile the image, row by row.
struct Tiling {
  int edge, columns, rows;
  std::vector<Sums> tiles;
};

Tiling sum_tiles(int width, int height, int edge, const std::vector<float>& a, const std::vector<float>& b,
                 const std::vector<float>& variance) {
  Tiling tiling{edge, (width + edge - 1) / edge, (height + edge - 1) / edge, {}};
  tiling.tiles.resize(static_cast<size_t>(tiling.columns) * static_cast<size_t>(tiling.rows));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
      Sums& sums = tiling.tiles[static_cast<size_t>(y / edge) * static_cast<size_t>(tiling.columns) +
                                static_cast<size_t>(x / edge)];
      const double v = variance[i], reference = b[i];
      sums.difference += a[i] - reference;
      sums.reference += std::abs(reference);
      sums.power += reference * reference;
      sums.variance.add(v, v * v);
      sums.pixels += 1;
    }
  }
  return tiling;
}

/// Largest edge up to `block` that gives at least kMinGroups groups, so that small images are tested, too.
int group_edge(int width, int height, int block) {
  for (int edge = block; edge > 1; --edge) {
    const auto tiles = [edge](int n) { return static_cast<size_t>((n + edge - 1) / edge); };
    if (tiles(width) * tiles(height) >= kMinGroups) return edge;
  }
  return 1;
}

MeanTest test_mean(const Tiling& groups, double scale, double alpha, double tolerance) {
  double n = static_cast<double>(groups.tiles.size()), pixels = 0, sum = 0, reference = 0;
  for (const Sums& g : groups.tiles) sum += g.difference, reference += g.reference, pixels += g.pixels;
  double second = 0, third = 0;
  for (const Sums& g : groups.tiles) {
    const double d = g.difference - sum / n;
    second += d * d, third += d * d * d;
  }
  MeanTest test;
  const double unit = scale > 0 ? scale * pixels : 1;
  test.difference = sum / unit;
  if (n < 2) return test;
  const double deviation = std::sqrt(second / (n - 1));  // of one group's sum
  test.standard_error = deviation * std::sqrt(n) / unit;
  const double shrunk = shrink(sum, tolerance * reference);
  if (shrunk != 0) {
    double t = kInfinity;
    if (deviation > 0) {
      const double s = shrunk / n / deviation, skewness = third / n / std::pow(second / n, 1.5);
      t = std::sqrt(n) *
          (s + skewness * s * s / 3 + skewness * skewness * s * s * s / 27 + skewness / (6 * n));
    }
    test.p = two_sided_p(t, n - 1);
  }
  test.detectable =
      tolerance * reference / unit + (two_sided_limit(alpha, n - 1) + kPowerQuantile) * test.standard_error;
  return test;
}

/// Variance of the tile's sum and its degrees of freedom: its own, or that of its 3x3 neighbours if larger.
/// Noise is about proportional to radiance, so it is v / (b^2 + dark^2) that neighbours are taken to have in
/// common.
std::pair<double, double> pooled_variance(const Tiling& tiling, int column, int row, double dark,
                                          bool exact) {
  const auto tile = [&](int c, int r) -> const Sums& {
    return tiling
        .tiles[static_cast<size_t>(r) * static_cast<size_t>(tiling.columns) + static_cast<size_t>(c)];
  };
  const auto power = [dark](const Sums& s) { return s.power + s.pixels * dark * dark; };
  const Sums& own = tile(column, row);
  if (exact || power(own) == 0) return {own.variance.sum, kInfinity};
  Variance pool;
  int count = 0;
  for (int r = std::max(0, row - 1); r <= std::min(tiling.rows - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(tiling.columns - 1, column + 1); ++c, ++count) {
      const Sums& other = tile(c, r);
      const double unit = power(other);
      pool.add(other.variance.sum / unit, other.variance.square / (unit * unit));
    }
  }
  const double pooled = pool.sum / count * power(own);
  return own.variance.sum > pooled ? std::pair{own.variance.sum, own.variance.dof()}
                                   : std::pair{pooled, pool.dof()};
}

/// Raises the variance of each pixel to that which the difference has within the pixel's block, around its
/// mean there and relative to brightness.
void raise_to_scatter(int width, int height, int edge, const std::vector<float>& a,
                      const std::vector<float>& b, double dark, std::vector<float>& variance) {
  const auto for_block = [&](int x0, int y0, const auto& body) {
    for (int y = y0; y < std::min(y0 + edge, height); ++y)
      for (int x = x0; x < std::min(x0 + edge, width); ++x) {
        const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
        body(i, std::hypot(double{b[i]}, dark));
      }
  };
  for (int y0 = 0; y0 < height; y0 += edge) {
    for (int x0 = 0; x0 < width; x0 += edge) {
      double n = 0, sum = 0, square = 0;
      for_block(x0, y0, [&](size_t i, double unit) {
        if (unit == 0) return;
        const double relative = (double{a[i]} - double{b[i]}) / unit;
        n += 1, sum += relative, square += relative * relative;
      });
      if (n < 2) continue;
      const double scatter = std::max(0.0, square - sum * sum / n) / (n - 1);
      for_block(x0, y0, [&](size_t i, double unit) {
        variance[i] = std::max(variance[i], static_cast<float>(scatter * unit * unit));
      });
    }
  }
}

/// Adds the blocks of channel `channel` to `test`, and their detectable biases to `detectable`.
void test_blocks(const Tiling& tiling, int channel, double dark, double alpha,
                 const DifferenceVariance& variance, double tolerance, BlockTest& test,
                 std::vector<double>& detectable) {
  for (int row = 0; row < tiling.rows; ++row) {
    for (int column = 0; column < tiling.columns; ++column) {
      const Sums& own = tiling.tiles[static_cast<size_t>(row) * static_cast<size_t>(tiling.columns) +
                                     static_cast<size_t>(column)];
      const auto [summed, dof] = pooled_variance(tiling, column, row, dark, variance.exact);
      const double deviation = std::sqrt(summed);
      const double shrunk = shrink(own.difference, tolerance * own.reference);
      const double t = shrunk == 0     ? 0
                       : deviation > 0 ? shrunk / deviation
                                       : std::copysign(kInfinity, shrunk);
      const double p = two_sided_p(t, dof);
      test.beyond += p < alpha;
      if (p < test.worst_p) {
        test.worst_t = t, test.worst_p = p;
        test.x = column * tiling.edge, test.y = row * tiling.edge, test.channel = channel;
        test.difference = own.difference / std::max(own.reference, 1e-30);
      }
      const double unit = std::max(own.reference, dark * own.pixels);
      if (unit > 0)
        detectable.push_back(tolerance + (two_sided_limit(alpha, dof) + kPowerQuantile) * deviation / unit);
    }
  }
}

/// Counts the pixels of one channel that lie beyond the limit of `alpha`.
uint64_t count_pixels_beyond(int width, int height, const std::vector<float>& a, const std::vector<float>& b,
                             const std::vector<float>& variance, double dark, bool exact, double alpha,
                             double tolerance) {
  constexpr int kReach = 2;  // neighbourhoods of 5x5
  const double normal_limit = two_sided_limit(alpha, kInfinity);
  const auto index = [width](int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  };
  const auto power = [&](size_t i) { return double{b[i]} * double{b[i]} + dark * dark; };
  uint64_t beyond = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const size_t i = index(x, y);
      const double shrunk = shrink(double{a[i]} - double{b[i]}, tolerance * std::abs(double{b[i]}));
      double v = variance[i], dof = kInfinity;
      // Student's tails are the heavier: what the normal limit and the pixel's own variance pass needs no
      // pool.
      if (shrunk * shrunk <= normal_limit * normal_limit * v) continue;
      if (!exact && power(i) > 0) {
        Variance pool;
        int count = 0;
        for (int py = std::max(0, y - kReach); py <= std::min(height - 1, y + kReach); ++py) {
          for (int px = std::max(0, x - kReach); px <= std::min(width - 1, x + kReach); ++px, ++count) {
            const double w = variance[index(px, py)] / power(index(px, py));
            pool.add(w, w * w);
          }
        }
        v = std::max(v, pool.sum / count * power(i));
        dof = pool.dof();
      }
      beyond += v <= 0 || two_sided_p(shrunk / std::sqrt(v), dof) < alpha;
    }
  }
  return beyond;
}

}  // namespace

ZTest z_test(int width, int height, const std::vector<std::vector<float>>& a,
             const std::vector<std::vector<float>>& b, const DifferenceVariance& given,
             const ZTestOptions& options) {
  const size_t channels = a.size(), pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
  CHECK_EQ(b.size(), channels);
  CHECK_EQ(given.channels.size(), channels);
  ZTest test;
  test.options = options;
  test.variance_from = given.from;
  const double alpha = sidak(options.level, 3);

  // Units of the channels: their means, but not much below that of the brightest.
  std::vector<double> mean(channels, 0.0);
  for (size_t c = 0; c < channels; ++c)
    for (float value : b[c]) mean[c] += std::abs(double{value}) / static_cast<double>(pixels);
  const double brightest = channels ? *std::max_element(mean.begin(), mean.end()) : 0;

  const int edge = group_edge(width, height, options.block);
  const auto blocks_along = [&](int n) {
    return static_cast<size_t>((n + options.block - 1) / options.block);
  };
  test.blocks.block = options.block;
  test.blocks.count = blocks_along(width) * blocks_along(height) * channels;
  test.pixels.count = pixels * channels;
  const double mean_alpha = sidak(alpha, static_cast<double>(channels));
  const double block_alpha = sidak(alpha, static_cast<double>(test.blocks.count));
  const double pixel_alpha = sidak(alpha, static_cast<double>(test.pixels.count));
  std::vector<double> detectable;
  for (size_t c = 0; c < channels; ++c) {
    const double scale = std::max(mean[c], 0.05 * brightest);
    // What rounding leaves in dark pixels, so that no variance is smaller.
    std::vector<float> variance = given.channels[c];
    const float floor = static_cast<float>(1e-12 * scale * scale);
    for (float& v : variance) v = std::max(v, floor);
    if (given.partial) raise_to_scatter(width, height, options.block, a[c], b[c], 0.05 * scale, variance);

    const Tiling groups = sum_tiles(width, height, edge, a[c], b[c], variance);
    test.means.push_back(test_mean(groups, scale, mean_alpha, options.tolerance));
    test.means_agree &= test.means.back().p >= mean_alpha;
    const Tiling blocks = sum_tiles(width, height, options.block, a[c], b[c], variance);
    test_blocks(blocks, static_cast<int>(c), 0.05 * scale, block_alpha, given, options.tolerance, test.blocks,
                detectable);
    test.pixels.beyond += count_pixels_beyond(width, height, a[c], b[c], variance, 0.05 * scale, given.exact,
                                              pixel_alpha, options.tolerance);
  }
  test.blocks_agree = test.blocks.beyond == 0;
  test.pixels_agree = test.pixels.share() <= kPixelShare;
  if (!detectable.empty()) {
    const auto middle = detectable.begin() + static_cast<std::ptrdiff_t>(detectable.size() / 2);
    std::nth_element(detectable.begin(), middle, detectable.end());
    test.blocks.detectable = *middle;
  }
  return test;
}

}  // namespace tachylite
