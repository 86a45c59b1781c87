// Microfacet distributions of the reference against the identities that define them.

#include <gtest/gtest.h>

#include "reference/bsdf/fresnel.h"
#include "reference/bsdf/rough_plastic.h"
#include "support/chi2.h"
#include "unit/reference_support.h"

namespace tachylite {
namespace {

using namespace reference;
using namespace test;

constexpr MicrofacetDistribution kBoth[] = {MicrofacetDistribution::kGgx, MicrofacetDistribution::kBeckmann};

/// The integral of value(m) over the upper hemisphere: midpoint rule in the polar coordinates of the slopes
/// over alpha.
template <class Value>
double integrate_normals(double alpha_u, double alpha_v, const Value& value) {
  constexpr int kRadii = 2000, kAngles = 200;
  double sum = 0;
  for (int i = 0; i < kRadii; ++i) {
    const double v = (i + 0.5) / kRadii, r = v / (1 - v);  // slope radius in units of alpha, 0 to infinity
    for (int j = 0; j < kAngles; ++j) {
      const double phi = 2 * kPi * (j + 0.5) / kAngles;
      const dvec3 m = glm::normalize(dvec3(-alpha_u * r * std::cos(phi), -alpha_v * r * std::sin(phi), 1));
      // dm = dp dq m.z^3, dp dq = alpha_u alpha_v r dr dphi, dr = dv / (1 - v)^2
      sum += value(m) * std::pow(m.z, 3) * alpha_u * alpha_v * r / sqr(1 - v);
    }
  }
  return sum * 2 * kPi / (double{kRadii} * kAngles);
}

/// Projected areas (Heitz 2014, eqs. 5 and 17): the integral of D m.z is 1, that of G1 D <w.m> is w.z.
TEST(ReferenceMicrofacets, AreNormalised) {
  for (const auto distribution : kBoth) {
    for (const auto& [au, av] : {std::pair(0.5, 0.5), std::pair(0.05, 0.3), std::pair(1.0, 1.0)}) {
      const Microfacets f(distribution, au, av);
      EXPECT_NEAR(integrate_normals(au, av, [&](const dvec3& m) { return f.d(m) * m.z; }), 1, 2e-3);
      for (const dvec3& w : {glm::normalize(dvec3(0.1, 0.2, 1)), glm::normalize(dvec3(1, -0.5, 0.2))}) {
        const double seen = integrate_normals(
            au, av, [&](const dvec3& m) { return f.g1(w, m) * f.d(m) * std::max(0.0, glm::dot(w, m)); });
        EXPECT_NEAR(seen, w.z, 3e-3 * w.z) << au << " " << av << " " << w.z;
      }
    }
  }
}

/// 50000 visible normals in 12 x 16 bins, from both sides; level 0.01 over all.
TEST(ReferenceMicrofacets, VisibleNormalsHaveTheirDensity) {
  for (const auto distribution : kBoth) {
    for (const auto& [au, av] : {std::pair(0.4, 0.4), std::pair(0.2, 0.6), std::pair(1.0, 1.0)}) {
      const Microfacets f(distribution, au, av);
      const SphereBins bins({.polar_bins = 12, .azimuth_bins = 16, .order = 8, .omc_max = 1, .exponent = 2});
      for (const dvec3& w : {dvec3(0, 0, 1), glm::normalize(dvec3(0.5, 0.3, 0.8)),
                             glm::normalize(dvec3(-1, 0.4, 0.1)), glm::normalize(dvec3(0.5, 0.3, -0.4))}) {
        std::vector<float> pdf;
        for (const glm::vec4& m : bins.quadrature_points()) {
          pdf.push_back(static_cast<float>(f.pdf(w, dvec3(m.x, m.y, m.z))));
        }
        Random random(1, 2, 3);
        std::vector<glm::vec4> normals;
        for (int i = 0; i < 50000; ++i) normals.emplace_back(f.sample(w, random.uniform2()), 0);
        std::vector<double> expected = bins.expected(pdf, 50000);
        expected.back() = std::max(0.0, expected.back());  // what quadrature leaves of 1
        const auto result = chi2_test(bins.count(normals), expected, sidak(0.01, 24));
        EXPECT_TRUE(result.accepted) << au << " " << av << " " << w.z << ": " << result.message;
      }
    }
  }
}

/// The quadratures of roughplastic against plain Monte Carlo over D m.z, which shares nothing with them.
TEST(ReferenceMicrofacets, RoughBoundaryTables) {
  for (const auto distribution : kBoth) {
    const double alpha = 0.4, eta = 1.5;
    const Microfacets f(distribution, alpha, alpha);
    for (const double c : {0.2, 0.6, 1.0}) {
      const dvec3 wo(std::sqrt(1 - c * c), 0, c);
      const double reflected = integrate_normals(alpha, alpha, [&](const dvec3& m) {
        const dvec3 wi = reflect(wo, m);
        const double mo = glm::dot(wo, m);
        return mo > 0 && wi.z > 0 ? fresnel_dielectric(mo, eta) * f.g(wo, wi, m) * f.d(m) * mo / c : 0;
      });
      EXPECT_NEAR(rough_boundary_reflectance(f, eta, c), reflected, 1e-3);
      const double transmitted = integrate_normals(alpha, alpha, [&](const dvec3& m) {
        const double mo = glm::dot(wo, m);
        if (mo <= 0) return 0.0;
        const DielectricBoundary b = dielectric_boundary(mo, eta);
        const dvec3 wt = refract(wo, m, b.cos_t, b.eta_ti);
        return wt.z < 0 ? (1 - b.reflectance) * f.g(wo, wt, m) * f.d(m) * mo / c : 0;
      });
      EXPECT_NEAR(rough_boundary_transmittance(f, eta, c), transmitted, 2e-3);
      EXPECT_LT(reflected + transmitted, 1);
      // Almost smooth: Fresnel's own values.
      const Microfacets smooth(distribution, 1e-4, 1e-4);
      EXPECT_NEAR(rough_boundary_reflectance(smooth, eta, c), fresnel_dielectric(c, eta), 1e-6);
      EXPECT_NEAR(rough_boundary_transmittance(smooth, eta, c), 1 - fresnel_dielectric(c, eta), 1e-6);
    }
  }
}

/// The long tails of GGX: values of 600 x 300 points of a Gauss rule over the spherical caps of visible normals.
TEST(ReferenceMicrofacets, RoughBoundaryOfGgx) {
  const auto transmitted = [](double alpha, double cos_o) {
    return rough_boundary_transmittance(Microfacets(MicrofacetDistribution::kGgx, alpha, alpha), 1.5, cos_o);
  };
  EXPECT_NEAR(transmitted(0.0382468, 20 / 63.), 0.810232939, 2e-5);
  EXPECT_NEAR(transmitted(0.0382468, 51 / 63.), 0.956058204, 2e-5);
  EXPECT_NEAR(transmitted(0.1, 20 / 63.), 0.817776422, 2e-5);
  EXPECT_NEAR(transmitted(0.1, 51 / 63.), 0.953998154, 2e-5);
}

}  // namespace
}  // namespace tachylite
