#pragma once

// Bins that follow a narrow lobe down to the horizon, where a cap about its axis would be cut.

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace tachylite::test {

/// A grid over the quarter of the sphere with wi.z > 0 (or below) and wi.x < 0, for a lobe about azimuth pi, in cos theta
/// and azimuth, warped (s -> s / (1 + |s|), s / sqrt(1 + s^2)) with the distance s from the lobe's axis in units of its
/// width: a GGX lobe is about uniform in it, and the horizon is an edge of bins.
class LobeBins {
 public:
  struct Options {
    double z = 0, z_width = 0.1;  // cos theta of the axis, and the lobe's width in it
    std::function<double(double z)> azimuth_width;
    bool below = false;
    int z_bins = 12, azimuth_bins = 10, order = 6;
  };
  explicit LobeBins(const Options& options);

  /// One entry a bin and one more for all else: other directions and refused samples (zero vectors).
  std::vector<double> count(std::span<const glm::vec4> directions) const;
  /// Expected counts, given the density w.r.t. solid angle [1/sr].
  std::vector<double> expected(const std::function<double(const glm::dvec3&)>& pdf, double samples) const;

  const std::vector<glm::dvec3>& quadrature_points() const { return points_; }
  std::vector<double> expected(std::span<const double> pdf, double samples) const;

 private:
  size_t bins() const { return static_cast<size_t>(options_.z_bins * options_.azimuth_bins); }

  Options options_;
  double t_low_, t_high_;  // warped z of the horizon and of the pole
  std::vector<glm::dvec3> points_;
  std::vector<double> weights_;  // [sr]
};

}  // namespace tachylite::test
