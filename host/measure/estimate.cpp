#include "measure/estimate.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <boost/math/distributions/students_t.hpp>

#include "base/check.h"

namespace tachylite {
namespace {

constexpr double kNormal975 = 1.959964;

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The bootstrap's spread of n data divides squares by n, where n less what was fitted to them is right.
double spread_correction(size_t n, size_t fitted) {
  return std::sqrt(static_cast<double>(n) / static_cast<double>(n - fitted));
}

}  // namespace

Replicates bootstrap_mean(std::span<const double> measurements, uint64_t seed) {
  CHECK(!measurements.empty());
  const size_t n = measurements.size();
  Replicates result{mean(measurements), std::vector<double>(kReplicates)};
  if (n == 1) {
    std::fill(result.drawn.begin(), result.drawn.end(), result.value);
    return result;
  }
  const double t975 = quantile(boost::math::students_t(static_cast<double>(n - 1)), 0.975);
  const double widening = spread_correction(n, 1) * t975 / kNormal975;
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<size_t> draw(0, n - 1);
  for (double& drawn : result.drawn) {
    double sum = 0;
    for (size_t i = 0; i < n; ++i) sum += measurements[draw(random)];
    const double m = sum / static_cast<double>(n);
    drawn = result.value > 0 && m > 0 ? result.value * std::pow(m / result.value, widening) : m;
  }
  return result;
}

Replicates bootstrap_blocks(std::span<const std::vector<double>> errors, size_t fitted, uint64_t seed) {
  CHECK_LT(fitted, errors.size());
  const size_t seeds = errors.size(), blocks = errors[0].size();
  Replicates result{0, std::vector<double>(kReplicates, 0.0)};
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<size_t> draw(0, seeds - 1);
  std::vector<double> block(seeds);
  for (size_t b = 0; b < blocks; ++b) {
    for (size_t s = 0; s < seeds; ++s) block[s] = errors[s][b];
    const double centre = mean(block);
    result.value += centre;
    for (double& drawn : result.drawn) {
      double sum = 0;
      for (size_t s = 0; s < seeds; ++s) sum += block[draw(random)];
      drawn += sum / static_cast<double>(seeds) - centre;
    }
  }
  const double widening = spread_correction(seeds, fitted);
  for (double& drawn : result.drawn) drawn = result.value + widening * drawn;
  return result;
}

Replicates combine(const Replicates& a, const Replicates& b, const std::function<double(double, double)>& f) {
  CHECK_EQ(a.drawn.size(), b.drawn.size());
  Replicates result{f(a.value, b.value), std::vector<double>(a.drawn.size())};
  for (size_t r = 0; r < a.drawn.size(); ++r) result.drawn[r] = f(a.drawn[r], b.drawn[r]);
  return result;
}

Estimate estimate(const Replicates& replicates) {
  std::vector<double> sorted = replicates.drawn;
  std::sort(sorted.begin(), sorted.end());
  const auto percentile = [&](double p) {
    const double place = p * static_cast<double>(sorted.size() - 1);
    const auto i = static_cast<size_t>(place);
    return sorted[i] + (place - static_cast<double>(i)) * (sorted[std::min(i + 1, sorted.size() - 1)] - sorted[i]);
  };
  Estimate result{replicates.value, percentile(0.025), percentile(0.975), 0};
  double sum = 0, square = 0, n = 0;
  for (double drawn : sorted) {
    if (!(drawn > 0)) continue;
    sum += std::log(drawn);
    square += std::log(drawn) * std::log(drawn);
    ++n;
  }
  if (n > 1) result.log_error = std::sqrt(std::max(square / n - sum * sum / (n * n), 0.0));
  return result;
}

Estimate ratio(const Estimate& a, const Estimate& b) {
  Estimate result;
  result.value = a.value / b.value;
  result.log_error = std::hypot(a.log_error, b.log_error);
  result.low = result.value * std::exp(-kNormal975 * result.log_error);
  result.high = result.value * std::exp(kNormal975 * result.log_error);
  return result;
}

}  // namespace tachylite
