// Rough materials seen at grazing angles, and lobes that the horizon cuts: bins that follow the lobe (LobeBins) against
// densities in double precision. The half vector of two float32 directions close to the horizon has lost the slope of
// its facet (to 6e-8 / cos theta), so that the device's own density serves only where that is small against alpha.
// Level of each test 1e-4; deviations of the density of about 7 % (root of the mean square) are seen with a power of
// 0.99.

#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/pi.h"
#include "shared/material.h"
#include "statistics/bsdf_materials.h"
#include "statistics/bsdf_probe.h"
#include "support/chi2.h"
#include "support/device_test.h"
#include "support/lobe_bins.h"

namespace tachylite::test {
namespace {

constexpr int kSamples = 40000;

double sqr(double x) { return x * x; }

/// wo at that angle from the normal, in the plane y = 0, where the smallest azimuths can be told apart.
glm::vec3 view(double degrees) {
  const double theta = degrees * kPi / 180;
  return glm::vec3(std::sin(theta), 0, std::cos(theta));
}

/// Density of reflected directions, w.r.t. their solid angle; wo.z, wi.z > 0. Walter et al. 2007 with visible normals;
/// for GGX metals the bounded ones of Eto and Tokuyoshi 2023, eq. 7 and 8. eta: 0 for a metal.
double reflection_pdf(bool ggx, double alpha, double eta, const glm::dvec3& wo, const glm::dvec3& wi) {
  const glm::dvec3 h = wo + wi, m = h / glm::length(h);
  const double r2 = (sqr(m.x) + sqr(m.y)) / sqr(alpha), spread = alpha * std::hypot(wo.x, wo.y);
  if (ggx) {
    const double density = 1 / (kPi * sqr(alpha) * sqr(r2 + sqr(m.z))), stretched = std::hypot(spread, wo.z);
    if (eta == 0) {
      const double s2 = sqr(1 + std::hypot(wo.x, wo.y)), a2 = sqr(std::min(alpha, 1.0));
      const double k = (1 - a2) * s2 / (s2 + a2 * sqr(wo.z));
      return density / (2 * (k * wo.z + stretched));
    }
    return density / (2 * (wo.z + stretched));
  }
  const double density = std::exp(-r2 / sqr(m.z)) / (kPi * sqr(alpha) * sqr(sqr(m.z)));
  const double a = spread > 0 ? wo.z / spread : 1e10;
  const double area = 0.5 * (wo.z * (1 + std::erf(a)) + spread * std::exp(-a * a) / std::sqrt(kPi));
  return density / (4 * area);
}

double fresnel(double c, double eta) {
  if (eta == 0) return 1;
  const double g2 = sqr(eta) - 1 + sqr(c);
  if (g2 <= 0) return 1;
  const double g = std::sqrt(g2), a = (g - c) / (g + c), b = (c * (g + c) - 1) / (c * (g - c) + 1);
  return 0.5 * sqr(a) * (1 + sqr(b));
}

std::vector<BsdfAnswer> draw(BsdfProbe& probe, int bsdf, const glm::vec3& wo) {
  std::mt19937 random(23);
  std::uniform_real_distribution<float> uniform(0, 1);
  const auto next = [&] { return std::min(uniform(random), 0x1.fffffep-1f); };
  std::vector<BsdfQuery> queries(kSamples);
  for (BsdfQuery& q : queries) q = {.bsdf = bsdf, .wo = wo, .u = {next(), next()}, .u_lobe = next()};
  return probe.ask(queries);
}

std::vector<glm::vec4> directions_of(const std::vector<BsdfAnswer>& answers) {
  std::vector<glm::vec4> directions;
  for (const BsdfAnswer& a : answers) directions.emplace_back(a.pdf > 0 ? a.wi : glm::vec3(0), 0);
  return directions;
}

void expect_counts(std::vector<double> observed, std::vector<double> expected, double level) {
  // What quadrature leaves of 1.
  if (std::abs(expected.back()) < 2e-3 * kSamples) expected.back() = std::max(expected.back(), 1e-9);
  const Chi2Result result = chi2_test(observed, expected, level);
  EXPECT_TRUE(result.accepted) << result.message << ", rest " << observed.back() << " of " << expected.back();
}

struct BsdfGrazing : DeviceTest {};

TEST_F(BsdfGrazing, NarrowReflectionsFollowTheirDensity) {
  const std::vector<MaterialCase> cases = rough_materials();
  std::vector<BsdfKind> kinds;
  for (const MaterialCase& c : cases) kinds.push_back(c.kind);
  BsdfProbe probe(scene_of_bsdfs(kinds));
  const std::vector<double> angles = {75, 85, 89, 89.9, 90.1, 95};
  const double level = sidak(1e-4, static_cast<int>(cases.size() * angles.size()));
  for (size_t i = 0; i < cases.size(); ++i) {
    const MaterialCase& c = cases[i];
    if (c.alpha > 0.02) continue;  // wide enough for the device's own density: bsdf_chi2_test
    const bool metal = c.eta == 1, ggx = c.name.find("ggx") != std::string::npos;
    for (const double angle : angles) {
      if (angle > 90 && !c.two_sided) continue;
      SCOPED_TRACE(fmt::format("{}, {} degrees", c.name, angle));
      const glm::vec3 wo = view(angle);
      const double side = wo.z > 0 ? 1 : -1, eta = metal ? 0 : wo.z > 0 ? c.eta : 1 / c.eta;
      const double z = std::abs(double(wo.z));
      const glm::dvec3 o(std::sqrt((1 - z) * (1 + z)), 0, z);  // unit to double precision
      const LobeBins bins({.z = o.z, .z_width = 2 * c.alpha, .azimuth_width = [&](double z_i) {
                             return c.alpha * (z + z_i) * std::hypot(1, (z_i - z) / (2 * c.alpha));
                           },
                           .below = side < 0});
      const auto pdf = [&](const glm::dvec3& wi) {
        const glm::dvec3 up(wi.x, wi.y, side * wi.z), h = glm::normalize(o + up);
        return fresnel(glm::dot(o, h), eta) * reflection_pdf(ggx, c.alpha, eta, o, up);
      };
      const auto answers = draw(probe, static_cast<int>(i), wo);
      expect_counts(bins.count(directions_of(answers)), bins.expected(pdf, kSamples), level);
      // The density that the device gives for what it draws.
      const double lost = 6e-8 / o.z / c.alpha;
      if (lost > 0.02) continue;
      for (const BsdfAnswer& a : answers) {
        if (a.pdf == 0 || a.wi.z * side <= 0) continue;
        ASSERT_NEAR(a.pdf / pdf(a.wi), 1, 2e-3 + 10 * lost);
      }
    }
  }
}

/// Light that leaves the denser side so that Snell's direction is 2 degrees above the horizon.
TEST_F(BsdfGrazing, NarrowRefractionsFollowTheirDensity) {
  const std::vector<MaterialCase> cases = rough_materials();
  std::vector<BsdfKind> kinds;
  for (const MaterialCase& c : cases) kinds.push_back(c.kind);
  BsdfProbe probe(scene_of_bsdfs(kinds));
  const double level = sidak(1e-4, static_cast<int>(cases.size()));
  for (size_t i = 0; i < cases.size(); ++i) {
    const MaterialCase& c = cases[i];
    if (c.alpha > 0.02 || c.eta == 1) continue;
    SCOPED_TRACE(c.name);
    const double dense = std::max(c.eta, 1 / c.eta);
    if (c.alpha * (1 - 1 / dense) < 1.01e-5) continue;  // light passes as through a smooth interface
    const double cos_t = std::cos(88 * kPi / 180), sin_t = std::sin(88 * kPi / 180);
    const double degrees = std::asin(sin_t / dense) * 180 / kPi;
    const glm::vec3 wo = view(c.eta > 1 ? 180 - degrees : degrees);
    const double cos_o = std::abs(wo.z), sin_o = sin_t / dense;
    // cos_t^2 = const + 2 eta^2 cos_o sin_o alpha s to first order in the slope s.
    const double step = c.alpha * sqr(dense) * cos_o * sin_o;
    const double azimuth_width = c.alpha * std::abs(cos_t - dense * cos_o) / sin_t;
    const LobeBins bins({.z = cos_t, .z_width = std::min(step / cos_t, std::sqrt(step)),
                         .azimuth_width = [&](double) { return azimuth_width; }, .below = wo.z > 0});
    std::vector<BsdfQuery> queries;
    for (const glm::dvec3& p : bins.quadrature_points())
      queries.push_back({.bsdf = static_cast<int>(i), .wo = wo, .wi = glm::vec3(p)});
    std::vector<double> pdf;
    for (const BsdfAnswer& a : probe.ask(queries)) pdf.push_back(a.f_pdf);
    expect_counts(bins.count(directions_of(draw(probe, static_cast<int>(i), wo))), bins.expected(pdf, kSamples), level);
  }
}

}  // namespace
}  // namespace tachylite::test
