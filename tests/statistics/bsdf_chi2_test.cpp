// Every bsdf draws from the density it claims, and weighs by it: on the device, over materials, roughness, angle of
// incidence and eta. The level of all tests together is 1e-4; a test sees deviations of the density of about 10 %
// (root of the mean square, relative) with a power of 0.99.

#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "shared/material.h"
#include "statistics/bsdf_materials.h"
#include "statistics/bsdf_probe.h"
#include "support/chi2.h"
#include "support/device_test.h"

namespace tachylite::test {
namespace {

constexpr int kSamples = 20000;
constexpr double kPi = std::numbers::pi;

glm::vec3 direction(double degrees, double azimuth = 0.4) {
  const double theta = degrees * kPi / 180;
  return glm::vec3(std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta));
}

/// Bins where the lobes of a material are: the sphere where they are wide, else about the mirror direction and the
/// refracted one.
std::vector<SphereBins::Options> bins_for(const MaterialCase& c, const glm::vec3& wo) {
  const SphereBins::Options sphere{.polar_bins = 20, .azimuth_bins = 16, .order = 20};
  if (c.alpha >= 0.2) return {sphere};
  std::vector<SphereBins::Options> result;
  const auto about = [&](const glm::dvec3& axis, double spread) {
    const double omc = 1 - std::cos(std::min(kPi, spread));
    result.push_back({.polar_bins = 14, .azimuth_bins = 12, .order = 10, .axis = glm::normalize(axis),
                      .omc_max = std::max(omc, 0.5 * spread * spread * 0.999), .exponent = 2});
    if (result.back().omc_max > 2) result.back().omc_max = 2;
  };
  const glm::dvec3 o(wo);
  about({-o.x, -o.y, o.z}, 12 * c.alpha);
  const double eta = wo.z > 0 ? c.eta : 1 / c.eta;
  const double cos_t2 = 1 - (1 - o.z * o.z) / (eta * eta);
  if (c.eta != 1 && cos_t2 > 0) {
    const double cos_t = std::sqrt(cos_t2);
    about({-o.x / eta, -o.y / eta, std::copysign(cos_t, -o.z)},
          std::min(12 * c.alpha * std::abs(1 - 1 / eta) / std::max(cos_t, 0.1), 1.0));
  }
  return result;
}

std::vector<BsdfQuery> sample_queries(int bsdf, const glm::vec3& wo, int count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  const auto next = [&] { return std::min(uniform(random), 0x1.fffffep-1f); };
  std::vector<BsdfQuery> queries(static_cast<size_t>(count));
  for (BsdfQuery& q : queries) q = {.bsdf = bsdf, .wo = wo, .u = {next(), next()}, .u_lobe = next()};
  return queries;
}

struct Bsdf : DeviceTest {};

void expect_density(const std::vector<MaterialCase>& cases) {
  std::vector<BsdfKind> kinds;
  for (const MaterialCase& c : cases) kinds.push_back(c.kind);
  BsdfProbe probe(scene_of_bsdfs(kinds));
  const std::vector<double> angles = {0, 30, 60, 85, 95, 140, 180};
  const double level = sidak(1e-4, 4 * static_cast<int>(cases.size() * angles.size()));
  for (size_t i = 0; i < cases.size(); ++i) {
    const MaterialCase& c = cases[i];
    if ((probe.material_class(static_cast<int>(i)).flags & gpu::kMaterialSmooth) == 0) continue;
    for (const double angle : angles) {
      if (angle > 90 && !c.two_sided) continue;
      // A narrow lobe at a grazing angle is cut by the horizon inside the bins, and no quadrature of them converges:
      // bsdf_grazing_test.
      if (c.alpha < 0.2 && std::abs(std::cos(angle * kPi / 180)) < 0.3) continue;
      SCOPED_TRACE(fmt::format("{}, {} degrees", c.name, angle));
      const glm::vec3 wo = direction(angle);
      const auto answers = probe.ask(sample_queries(static_cast<int>(i), wo, kSamples, 17));
      std::vector<glm::vec4> directions;
      double worst_weight = 0, worst_pdf = 0;
      for (const BsdfAnswer& a : answers) {
        directions.emplace_back(a.pdf > 0 ? a.wi : glm::vec3(0), 0);
        if (a.pdf == 0) continue;
        worst_pdf = std::max(worst_pdf, std::abs(double(a.f_pdf) / a.pdf - 1));
        for (int k = 0; k < 3; ++k) {
          const double w = double(a.f[k]) / a.f_pdf;
          worst_weight = std::max(worst_weight, std::abs(w - a.weight[k]) / std::max(w, 1e-3));
        }
        ASSERT_NEAR(glm::length(glm::dvec3(a.wi)), 1, 1e-6);
      }
      EXPECT_LT(worst_weight, 1e-3);
      EXPECT_LT(worst_pdf, std::max(1e-3, 3e-6 / c.alpha));
      for (const SphereBins::Options& options : bins_for(c, wo)) {
        const SphereBins bins(options);
        std::vector<BsdfQuery> queries;
        for (const glm::vec4& p : bins.quadrature_points())
          queries.push_back({.bsdf = static_cast<int>(i), .wo = wo, .wi = glm::vec3(p)});
        std::vector<float> pdf;
        for (const BsdfAnswer& a : probe.ask(queries)) pdf.push_back(a.f_pdf);
        std::vector<double> expected = bins.expected(pdf, kSamples);
        if (expected.back() < 0 && expected.back() > -1e-3 * kSamples) expected.back() = 1e-9;  // quadrature error
        const Chi2Result result = chi2_test(bins.count(directions), expected, level);
        EXPECT_TRUE(result.accepted) << result.message << ", integral " << bins.integral(pdf) << " omc max "
                                     << options.omc_max;
      }
    }
  }
}

TEST_F(Bsdf, AllMaterialsDrawFromTheirDensity) { expect_density(all_materials()); }
TEST_F(Bsdf, RoughOnesDrawFromTheirDensity) { expect_density(rough_materials()); }

}  // namespace
}  // namespace tachylite::test
