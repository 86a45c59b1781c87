// Glass seen from its dense side, within 1e-3 to 1e-5 of the critical angle, under a sky of radiance 1 on both sides:
// what is reflected shows 1, what is refracted eta^2 (a ray keeps its radiance over the square of the index), so a
// pixel is F + (1 - F) eta^2. Beyond the critical angle it is 1. The camera is orthographic: all rays have one angle.

#include <cmath>

#include <fmt/format.h>

#include "stress/stress_case.h"

namespace tachylite::test {
namespace {

constexpr double kEta = 1.5;
const double kCritical = std::asin(1 / kEta);

/// Fresnel reflectance from the dense side, by the cosine of incidence.
double reflectance(double c) {
  const double sin2_t = kEta * kEta * (1 - c * c);
  if (sin2_t >= 1) return 1;
  const double ct = std::sqrt(1 - sin2_t);
  const double s = (kEta * c - ct) / (kEta * c + ct), p = (c - kEta * ct) / (c + kEta * ct);
  return 0.5 * (s * s + p * p);
}

/// A plane at z = 0 whose dense side is below or, with an index below 1, above; the camera is on the dense side.
Scene plane(double angle, bool dense_above, const std::string& type, const std::string& roughness = "") {
  const double z = (dense_above ? 1 : -1) * std::cos(angle);
  return scene_from_elements(fmt::format(R"(<integrator type="path"><integer name="max_depth" value="4"/>
<integer name="rr_depth" value="100"/></integrator><sensor type="orthographic"><transform name="to_world">
<scale value="0.01"/><lookat origin="{:.17g}, 0, {:.17g}" target="0, 0, 0" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/><rfilter type="box"/></film>
</sensor><shape type="rectangle"><bsdf type="{}">
<float name="int_ior" value="{}"/><float name="ext_ior" value="{}"/>{}</bsdf>
</shape><emitter type="constant"/>)", -std::sin(angle), z, type, dense_above ? 1 : kEta, dense_above ? kEta : 1,
                                         roughness));
}

using CriticalAngle = DeviceTest;

TEST_F(CriticalAngle, SmoothGlass) {
  for (const auto& [difference, dense_above] : {std::pair(-1e-3, false), {-1e-5, true}, {1e-5, false}}) {
    const double angle = kCritical + difference, f = reflectance(std::cos(angle));
    StressCase c{.name = fmt::format("glass, {:+.0e} from the critical angle, {}", difference,
                                     dense_above ? "eta < 1" : "from inside"),
                 .samples = 1024, .error = mean_beyond_noise(glm::dvec3(f + (1 - f) * kEta * kEta))};
    if (difference > 0) {
      c.samples = 16;
      c.bound = 1e-6;
      c.error = worst_pixel(1);
    } else {
      // 1 - F goes with the root of the difference, of which float32 directions leave 2^-23 uncertain.
      c.bound = 1e-6 + (1 - f) * (kEta * kEta - 1) * 0.5 * std::ldexp(1.0, -23) / -difference;
    }
    expect_stress(plane(angle, dense_above, "dielectric"), c);
  }
}

// Beckmann facets of slopes (p, q) are seen with the density P22(p, q) (wo . m) / (wo . n); what leaves one in the
// direction w is masked by G1(w) (Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces",
// equations 20, 21, 23, 25; Heitz 2014, "Understanding the Masking-Shadowing Function", section 3).
double masking(double z, double alpha) {
  const double a = std::abs(z) / std::sqrt(std::max(1 - z * z, 1e-300)) / alpha;
  return 1 / (1 + 0.5 * (std::erf(a) - 1 + std::exp(-a * a) / (a * std::sqrt(M_PI))));
}
double rough_radiance(double angle, double alpha) {
  constexpr int kP = 20000, kQ = 24;
  const glm::dvec3 wo(std::sin(angle), 0, std::cos(angle));
  double sum = 0, weights = 0;
  for (int i = 0; i < kP; ++i)
    for (int j = 0; j < kQ; ++j) {
      const double p = 6 * ((2 * i + 1.0) / kP - 1), q = 6 * ((2 * j + 1.0) / kQ - 1);  // over alpha
      const glm::dvec3 slope(-alpha * p, -alpha * q, 1), m = glm::normalize(slope);
      const double weight = std::exp(-p * p - q * q) * glm::dot(wo, slope), c = glm::dot(wo, m), f = reflectance(c);
      double radiance = f * masking((2 * c * m - wo).z, alpha);
      if (f < 1) {
        const double ct = std::sqrt(1 - kEta * kEta * (1 - c * c));
        const double z = (kEta * c - ct) * m.z - kEta * wo.z;
        if (z < 0) radiance += (1 - f) * kEta * kEta * masking(z, alpha);
      }
      sum += weight * radiance;
      weights += weight;
    }
  return sum / weights;
}

TEST_F(CriticalAngle, RoughGlass) {
  constexpr double kAlpha = 1e-3;
  expect_stress(plane(kCritical, true, "roughdielectric", fmt::format(
                    R"(<string name="distribution" value="beckmann"/><float name="alpha" value="{}"/>)", kAlpha)),
                {.name = "rough glass of 0.001 at the critical angle", .samples = 1024, .bound = 1e-5,
                 .error = mean_beyond_noise(glm::dvec3(rough_radiance(kCritical, kAlpha)))});
}

}  // namespace
}  // namespace tachylite::test
