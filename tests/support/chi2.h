#pragma once

// Does a sampling routine draw from the density it claims? Pearson's chi2 test of sample counts in bins
// against integrals of the density over the bins.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace tachylite::test {

/// The level of each of `tests` independent tests, so that all of them together have the level `level`
/// (Sidak).
double sidak(double level, int tests);

struct GaussRule {
  std::vector<double> nodes, weights;  // on [0, 1]
};
GaussRule gauss_legendre(int order);

struct Chi2Result {
  bool accepted = false;
  double statistic = 0, p_value = 0;
  int degrees_of_freedom = 0;
  /// The relative standard deviation of the true density from the claimed one that is seen with a power of
  /// 0.99.
  double detectable = 0;
  std::string message;  // one line with all of these, or what is wrong
};

/// Bins with fewer than 5 expected counts are pooled. Counts where none are expected are a failure by
/// themselves. Both spans have one entry a bin; their sums must agree to 1e-4 relative (else the densities do
/// not integrate to what was sampled). Use: `const auto r = chi2_test(...); EXPECT_TRUE(r.accepted) <<
/// r.message;`
Chi2Result chi2_test(std::span<const double> observed, std::span<const double> expected, double level);

/// For points in [0, 1)^2 that should be uniform.
Chi2Result chi2_test_uniform_square(std::span<const glm::dvec2> points, int bins_per_side, double level);

/// Bins on the unit sphere, or on the part within an angle of an axis: a grid in (1 - cos theta, phi) about
/// the axis.
class SphereBins {
 public:
  struct Options {
    int polar_bins = 16, azimuth_bins = 16;
    int order = 6;             // Gauss-Legendre points of a bin per side
    glm::dvec3 axis{0, 0, 1};  // unit; put it where a narrow lobe is
    double omc_max = 2;        // covers 1 - cos theta <= omc_max: 2 the sphere, 1 the hemisphere
    double exponent = 1;       // polar edges at omc_max (i / polar_bins)^exponent: above 1, finer at the axis
  };
  explicit SphereBins(const Options& options);

  /// One entry a bin and one more: all else, directions outside and samples that were refused (zero vectors).
  size_t size() const { return static_cast<size_t>(options_.polar_bins * options_.azimuth_bins) + 1; }
  std::vector<double> count(std::span<const glm::vec4> directions) const;  // .xyz, unit

  /// Where the density must be known: order^2 directions a bin, bin by bin.
  const std::vector<glm::vec4>& quadrature_points() const { return points_; }
  /// Expected counts of `samples` samples: the integral over each bin of the density w.r.t. solid angle
  /// [1/sr], given at the quadrature points; what is left of 1 goes to the last entry.
  std::vector<double> expected(std::span<const float> pdf, double samples) const;
  /// The integral of that density over all bins.
  double integral(std::span<const float> pdf) const;

 private:
  Options options_;
  glm::dvec3 s_, t_;  // complete the axis to a frame
  std::vector<glm::vec4> points_;
  std::vector<double> weights_;  // [sr]
};

}  // namespace tachylite::test
