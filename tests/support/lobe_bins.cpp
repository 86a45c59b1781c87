#include "support/lobe_bins.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "support/chi2.h"

namespace tachylite::test {
namespace {

constexpr double kQuarterTurn = 0.5 * std::numbers::pi;

// Of z: a GGX lobe of visible normals falls off as s^-2 at grazing angles. Of the azimuth: as (1 + s^2)^-2.
double warp_z(double s) { return s / (1 + std::abs(s)); }
double unwarp_z(double t) { return t / (1 - std::abs(t)); }
double unwarp_z_derivative(double t) { return 1 / ((1 - std::abs(t)) * (1 - std::abs(t))); }
double warp(double s) { return s / std::sqrt(1 + s * s); }
double unwarp(double t) { return t / std::sqrt(1 - t * t); }
double unwarp_derivative(double t) { return std::pow(1 - t * t, -1.5); }

}  // namespace

LobeBins::LobeBins(const Options& options)
    : options_(options),
      t_low_(warp_z(-options.z / options.z_width)),
      t_high_(warp_z((1 - options.z) / options.z_width)) {
  const GaussRule rule = gauss_legendre(options.order);
  for (int i = 0; i < options.z_bins; ++i) {
    for (int j = 0; j < options.azimuth_bins; ++j) {
      for (size_t a = 0; a < rule.nodes.size(); ++a) {
        const double step = (t_high_ - t_low_) / options.z_bins;
        const double t_z = t_low_ + step * (i + rule.nodes[a]);
        const double z = std::clamp(options.z + options.z_width * unwarp_z(t_z), 0.0, 1.0);
        const double width = options_.azimuth_width(z), t_end = warp(kQuarterTurn / width);
        const double r = std::sqrt((1 - z) * (1 + z));
        for (size_t b = 0; b < rule.nodes.size(); ++b) {
          const double t_phi = t_end * (2 * (j + rule.nodes[b]) / options.azimuth_bins - 1);
          const double phi = width * unwarp(t_phi);
          points_.emplace_back(-r * std::cos(phi), r * std::sin(phi), options.below ? -z : z);
          weights_.push_back(rule.weights[a] * step * options.z_width * unwarp_z_derivative(t_z) * rule.weights[b] * 2 *
                             t_end / options.azimuth_bins * width * unwarp_derivative(t_phi));
        }
      }
    }
  }
}

std::vector<double> LobeBins::count(std::span<const glm::vec4> directions) const {
  std::vector<double> counts(bins() + 1);
  const auto bin = [](double x, int n) { return std::clamp(static_cast<int>(x * n), 0, n - 1); };
  for (const glm::vec4& direction : directions) {
    const glm::dvec3 d(direction);
    const double z = options_.below ? -d.z : d.z;
    if (!(z > 0 && d.x < 0)) {
      ++counts.back();
      continue;
    }
    const double width = options_.azimuth_width(z), phi = std::atan2(d.y, -d.x);
    const int i = bin((warp_z((z - options_.z) / options_.z_width) - t_low_) / (t_high_ - t_low_), options_.z_bins);
    const int j = bin(0.5 * (warp(phi / width) / warp(kQuarterTurn / width) + 1), options_.azimuth_bins);
    ++counts[static_cast<size_t>(i * options_.azimuth_bins + j)];
  }
  return counts;
}

std::vector<double> LobeBins::expected(std::span<const double> pdf, double samples) const {
  CHECK_EQ(pdf.size(), points_.size());
  std::vector<double> counts(bins() + 1);
  const size_t points_per_bin = points_.size() / bins();
  double rest = samples;
  for (size_t i = 0; i < points_.size(); ++i) {
    const double mass = samples * weights_[i] * pdf[i];
    counts[i / points_per_bin] += mass;
    rest -= mass;
  }
  counts.back() = rest;
  return counts;
}

std::vector<double> LobeBins::expected(const std::function<double(const glm::dvec3&)>& pdf, double samples) const {
  std::vector<double> values;
  for (const glm::dvec3& point : points_) values.push_back(pdf(point));
  return expected(values, samples);
}

}  // namespace tachylite::test
