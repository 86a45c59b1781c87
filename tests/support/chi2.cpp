#include "support/chi2.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/special_functions/legendre.hpp>

#include "base/check.h"
#include "base/pi.h"

namespace tachylite::test {
namespace {

constexpr double kFewestCounts = 5;
constexpr double kPower = 0.99;

}  // namespace

GaussRule gauss_legendre(int order) {
  GaussRule rule;
  for (double zero : boost::math::legendre_p_zeros<double>(order)) {  // those >= 0
    const double slope = boost::math::legendre_p_prime(order, zero);
    const double weight = 1 / ((1 - zero * zero) * slope * slope);
    for (double node : {zero, -zero}) {
      rule.nodes.push_back(0.5 * (1 + node));
      rule.weights.push_back(weight);
      if (zero == 0) break;
    }
  }
  return rule;
}

double sidak(double level, int tests) {
  return -std::expm1(std::log1p(-level) / tests);
}

Chi2Result chi2_test(std::span<const double> observed, std::span<const double> expected, double level) {
  CHECK_EQ(observed.size(), expected.size());
  Chi2Result result;
  const double samples = std::accumulate(observed.begin(), observed.end(), 0.0);
  const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
  if (!(std::abs(total - samples) <= 1e-4 * samples)) {
    result.message = fmt::format("{} samples, but {} are expected", samples, total);
    return result;
  }
  double pooled_observed = 0, pooled_expected = 0;
  int bins = 0;
  const auto add = [&](double count, double mean) {
    result.statistic += (count - mean) * (count - mean) / mean;
    ++bins;
  };
  for (size_t i = 0; i < observed.size(); ++i) {
    if (expected[i] >= kFewestCounts) {
      add(observed[i], expected[i]);
    } else if (!(expected[i] > 0)) {
      if (observed[i] > 0 || expected[i] < 0) {
        result.message = fmt::format("bin {}: {} samples where {} are expected", i, observed[i], expected[i]);
        return result;
      }
    } else {
      pooled_observed += observed[i];
      pooled_expected += expected[i];
    }
  }
  if (pooled_expected >= kFewestCounts) {
    add(pooled_observed, pooled_expected);
  } else if (pooled_observed > pooled_expected + 10 * std::sqrt(pooled_expected) + kFewestCounts) {
    // Too little is expected for chi2: the bound has a level below 1e-6 for a Poisson variable of mean
    // below 5.
    result.message =
        fmt::format("{} samples in bins where {} are expected", pooled_observed, pooled_expected);
    return result;
  }
  if (bins < 2) {
    result.message = fmt::format("only {} bins with {} expected samples or more", bins, kFewestCounts);
    return result;
  }
  result.degrees_of_freedom = bins - 1;
  const boost::math::chi_squared distribution(result.degrees_of_freedom);
  result.p_value = boost::math::cdf(boost::math::complement(distribution, result.statistic));
  result.accepted = result.p_value >= level;
  const double critical = boost::math::quantile(boost::math::complement(distribution, level));
  const double noncentrality = boost::math::non_central_chi_squared::find_non_centrality(
      static_cast<double>(result.degrees_of_freedom), critical, 1 - kPower);
  result.detectable = std::sqrt(noncentrality / samples);
  result.message = fmt::format(
      "chi2 = {:.1f} with {} degrees of freedom, p = {:.3g} (level {:.3g}); sees relative deviations of the "
      "density of "
      "{:.3g} with a power of {}",
      result.statistic, result.degrees_of_freedom, result.p_value, level, result.detectable, kPower);
  return result;
}

Chi2Result chi2_test_uniform_square(std::span<const glm::dvec2> points, int bins_per_side, double level) {
  const auto bins = static_cast<size_t>(bins_per_side) * static_cast<size_t>(bins_per_side);
  std::vector<double> observed(bins + 1),
      expected(bins + 1, static_cast<double>(points.size()) / static_cast<double>(bins));
  expected[bins] = 0;  // outside
  for (const glm::dvec2& point : points) {
    const bool inside = point.x >= 0 && point.x < 1 && point.y >= 0 && point.y < 1;
    ++observed[inside ? static_cast<size_t>(point.y * bins_per_side) * static_cast<size_t>(bins_per_side) +
                            static_cast<size_t>(point.x * bins_per_side)
                      : bins];
  }
  return chi2_test(observed, expected, level);
}

SphereBins::SphereBins(const Options& options) : options_(options) {
  const glm::dvec3 helper = std::abs(options.axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  s_ = glm::normalize(glm::cross(helper, options.axis));
  t_ = glm::cross(options.axis, s_);
  const GaussRule rule = gauss_legendre(options.order);
  for (int i = 0; i < options.polar_bins; ++i) {
    const double low = options.omc_max * std::pow(double(i) / options.polar_bins, options.exponent);
    const double high = options.omc_max * std::pow(double(i + 1) / options.polar_bins, options.exponent);
    for (int j = 0; j < options.azimuth_bins; ++j) {
      const double width = 2 * kPi / options.azimuth_bins;
      for (int a = 0; a < options.order; ++a) {
        for (int b = 0; b < options.order; ++b) {
          const double omc = low + (high - low) * rule.nodes[static_cast<size_t>(a)];
          const double phi = width * (j + rule.nodes[static_cast<size_t>(b)]);
          const double sine = std::sqrt(omc * (2 - omc));
          const glm::dvec3 direction =
              options.axis * (1 - omc) + s_ * (sine * std::cos(phi)) + t_ * (sine * std::sin(phi));
          points_.emplace_back(glm::vec3(direction), 0);
          weights_.push_back((high - low) * rule.weights[static_cast<size_t>(a)] * width *
                             rule.weights[static_cast<size_t>(b)]);
        }
      }
    }
  }
}

std::vector<double> SphereBins::count(std::span<const glm::vec4> directions) const {
  std::vector<double> counts(size());
  for (const glm::vec4& direction : directions) {
    const glm::dvec3 d(direction);
    const glm::dvec3 from_axis = d - options_.axis;
    const double omc = 0.5 * glm::dot(from_axis, from_axis);  // keeps its digits near the axis
    if (!(glm::dot(d, d) > 0.25) || omc > options_.omc_max) {
      ++counts.back();
      continue;
    }
    const double turns = std::atan2(glm::dot(d, t_), glm::dot(d, s_)) / (2 * kPi);
    const int polar =
        static_cast<int>(options_.polar_bins * std::pow(omc / options_.omc_max, 1 / options_.exponent));
    const int azimuth = static_cast<int>(options_.azimuth_bins * (turns - std::floor(turns)));
    ++counts[static_cast<size_t>(std::min(polar, options_.polar_bins - 1) * options_.azimuth_bins +
                                 std::min(azimuth, options_.azimuth_bins - 1))];
  }
  return counts;
}

std::vector<double> SphereBins::expected(std::span<const float> pdf, double samples) const {
  CHECK_EQ(pdf.size(), points_.size());
  std::vector<double> counts(size());
  const size_t points_per_bin = points_.size() / (size() - 1);
  double rest = 1;
  for (size_t bin = 0; bin + 1 < size(); ++bin) {
    double integral_of_bin = 0;
    for (size_t i = bin * points_per_bin; i < (bin + 1) * points_per_bin; ++i)
      integral_of_bin += weights_[i] * static_cast<double>(pdf[i]);
    counts[bin] = samples * integral_of_bin;
    rest -= integral_of_bin;
  }
  // A density that integrates to 1 leaves a rounding, of either sign.
  counts.back() = samples * (std::abs(rest) < 1e-6 ? 1e-9 : rest);
  return counts;
}

double SphereBins::integral(std::span<const float> pdf) const {
  CHECK_EQ(pdf.size(), points_.size());
  double sum = 0;
  for (size_t i = 0; i < pdf.size(); ++i) sum += weights_[i] * static_cast<double>(pdf[i]);
  return sum;
}

}  // namespace tachylite::test
