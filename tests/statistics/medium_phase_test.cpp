// Phase functions: samples follow their density, which is Henyey and Greenstein's, for all g.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/chi2.h"
#include "support/device_test.h"

namespace tachylite::test {
namespace {

using MediumPhase = DeviceTest;

struct Push {
  glm::vec4 d;
  float g;
  uint32_t count;
};

std::vector<glm::vec4> run_phase(float g, const glm::dvec3& d, std::span<const glm::vec4> directions, bool density) {
  KernelRun run("medium_phase");
  run.storage(0, directions).output<glm::vec4>(1, directions.size()).constant(0, density);
  run.push(Push{glm::vec4(glm::vec3(d), 0), g, static_cast<uint32_t>(directions.size())});
  return run.run(directions.size()).result<glm::vec4>(1);
}

double henyey_greenstein(double g, double omc) {
  const double q = (1 - g) * (1 - g) + 2 * g * omc;
  return (1 - g * g) / (4 * std::numbers::pi * q * std::sqrt(q));
}

const std::vector<float> kG = {0, 1e-5f, 0.3f, -0.7f, 0.9f, 0.99f, 0.999f, 0.9999f, -0.9999f};

TEST_F(MediumPhase, Chi2) {
  constexpr size_t kSamples = 1 << 18;
  const std::vector<glm::vec4> none(kSamples);
  const double level = sidak(1e-3, static_cast<int>(kG.size()));
  for (float g : kG) {
    // Narrow lobes along z, where float directions have digits to spare.
    const glm::dvec3 d = std::abs(g) < 0.95f ? glm::normalize(glm::dvec3(1, -2, 0.5)) : glm::dvec3(0, 0, 1);
    SphereBins::Options options;
    options.polar_bins = 64;
    options.azimuth_bins = 4;
    options.order = 8;
    options.axis = g < 0 ? -d : d;
    options.exponent = std::abs(g) < 0.95f ? 2 : 8;
    const SphereBins bins(options);
    std::vector<float> pdf;
    for (const glm::vec4& value : run_phase(g, d, bins.quadrature_points(), true)) pdf.push_back(value.x);
    EXPECT_NEAR(bins.integral(pdf), 1, 2e-4) << g;
    const Chi2Result result =
        chi2_test(bins.count(run_phase(g, d, none, false)), bins.expected(pdf, kSamples), level);
    EXPECT_TRUE(result.accepted) << "g = " << g << ": " << result.message;
    EXPECT_LT(result.detectable, 0.03) << g;
  }
}

TEST_F(MediumPhase, DensityAgreesWithDouble) {
  std::vector<glm::vec4> directions;
  for (double omc : {0.0, 1e-9, 1e-6, 1e-3, 0.5, 1.0, 1.9, 2.0})
    directions.emplace_back(std::sqrt(omc * (2 - omc)), 0, 1 - omc, 0);
  for (float g : kG) {
    const auto densities = run_phase(g, glm::dvec3(0, 0, 1), directions, true);
    for (size_t i = 0; i < directions.size(); ++i) {
      const glm::dvec3 off = glm::dvec3(directions[i]) - glm::dvec3(0, 0, g < 0 ? -1 : 1);
      const double expected = henyey_greenstein(std::abs(double{g}), 0.5 * glm::dot(off, off));
      EXPECT_NEAR(densities[i].x / expected, 1, 2e-6) << g << " " << i;
    }
  }
}

TEST_F(MediumPhase, MeanCosineIsG) {
  constexpr size_t kSamples = 1 << 18;
  const std::vector<glm::vec4> none(kSamples);
  for (float g : kG) {
    double sum = 0, squares = 0;
    for (const glm::vec4& wi : run_phase(g, glm::dvec3(0, 0, 1), none, false)) {
      const double complement = 1 - double{wi.z} * (g < 0 ? -1 : 1);
      sum += complement;
      squares += complement * complement;
      EXPECT_NEAR(glm::length(glm::dvec3(wi)), 1, 3e-7);
    }
    const double mean = sum / kSamples, deviation = std::sqrt((squares / kSamples - mean * mean) / kSamples);
    EXPECT_NEAR(mean, 1 - std::abs(double{g}), 5 * deviation + 1e-7) << g;  // 5.7e-7 each
  }
}

}  // namespace
}  // namespace tachylite::test
