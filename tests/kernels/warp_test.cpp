// base/warp.glsl and base/frame.glsl: every map draws from its density, on the device.

#include <cmath>
#include <numbers>

#include "support/chi2.h"
#include "support/device_test.h"

namespace tachylite::test {
namespace {

enum Map : uint32_t { kDisk, kTriangle, kCosine, kSphere, kHemisphere, kCone, kFrame };

constexpr uint32_t kSamples = 1 << 18;
const double kLevel = sidak(1e-4, 20);  // of each of the tests here, about 20

struct Push {
  uint32_t count, seed;
  float omc;
};

std::vector<glm::vec4> run(Map map, float omc, const std::vector<glm::vec4>& directions = {}) {
  const bool density = !directions.empty() && map != kFrame;
  const auto count =
      directions.empty() ? kSamples : static_cast<uint32_t>(directions.size()) * (map == kFrame ? 3 : 1);
  KernelRun kernel("warp");
  kernel.constant(0, map).constant(1, density).push(Push{count, 7, omc});
  kernel.storage(0, std::span<const glm::vec4>(directions)).output<glm::vec4>(1, count);
  return kernel.run(count).result<glm::vec4>(1);
}

void expect_density(Map map, SphereBins::Options options, float omc = 0) {
  const SphereBins bins(options);
  std::vector<float> pdf;
  for (const glm::vec4& value : run(map, omc, bins.quadrature_points())) pdf.push_back(value.x);
  EXPECT_NEAR(bins.integral(pdf), 1, 1e-5);
  const std::vector<glm::vec4> samples = run(map, omc);
  const Chi2Result result = chi2_test(bins.count(samples), bins.expected(pdf, kSamples), kLevel);
  EXPECT_TRUE(result.accepted) << result.message;
  EXPECT_LT(result.detectable, 0.03);
  for (const glm::vec4& sample : samples) {
    const double length = glm::length(glm::dvec3(sample));
    ASSERT_NEAR(length, 1, 3e-7);
  }
}

class Warp : public DeviceTest {};

TEST_F(Warp, CosineHemisphere) {
  expect_density(kCosine, {.omc_max = 1});
}
TEST_F(Warp, UniformSphere) {
  expect_density(kSphere, {});
}
TEST_F(Warp, UniformHemisphere) {
  expect_density(kHemisphere, {.omc_max = 1});
}
TEST_F(Warp, UniformCone) {
  for (float omc : {2.0f, 0.5f, 1e-3f, 1e-7f})
    expect_density(kCone, {.omc_max = static_cast<double>(omc) * (1 + 1e-6)}, omc);
}

TEST_F(Warp, UniformDisk) {
  std::vector<glm::dvec2> square;
  for (const glm::vec4& p : run(kDisk, 0)) {
    const glm::dvec2 q(p);
    const double turns = std::atan2(q.y, q.x) / (2 * std::numbers::pi);
    square.emplace_back(std::min(glm::dot(q, q), 1 - 1e-9), turns - std::floor(turns));
    ASSERT_LE(glm::dot(q, q), 1 + 1e-6);
    ASSERT_FLOAT_EQ(p.w, static_cast<float>(1 / std::numbers::pi));
  }
  const Chi2Result result = chi2_test_uniform_square(square, 24, kLevel);
  EXPECT_TRUE(result.accepted) << result.message;
}

TEST_F(Warp, UniformTriangle) {
  std::vector<glm::dvec2> square;
  for (const glm::vec4& p : run(kTriangle, 0)) {
    const glm::dvec3 b(p);
    ASSERT_GE(std::min({b.x, b.y, b.z}), 0);
    ASSERT_NEAR(b.x + b.y + b.z, 1, 1e-7);
    // P(b0 > x) = (1 - x)^2; given b0, b1 is uniform in [0, 1 - b0).
    square.emplace_back(std::min((1 - b.x) * (1 - b.x), 1 - 1e-9), std::min(b.y / (1 - b.x), 1 - 1e-9));
  }
  const Chi2Result result = chi2_test_uniform_square(square, 24, kLevel);
  EXPECT_TRUE(result.accepted) << result.message;
}

// The helper itself: a density that is off by 5 % on half of the sphere must be refused.
TEST_F(Warp, Chi2SeesAWrongDensity) {
  const SphereBins bins({});
  const std::vector<glm::vec4> samples = run(kSphere, 0);
  std::vector<float> pdf;
  for (const glm::vec4& d : bins.quadrature_points())
    pdf.push_back(static_cast<float>(0.25 / std::numbers::pi * (d.x > 0 ? 1.05 : 0.95)));
  const Chi2Result result = chi2_test(bins.count(samples), bins.expected(pdf, kSamples), kLevel);
  EXPECT_LT(result.detectable, 0.05);
  EXPECT_FALSE(result.accepted) << result.message;
  std::vector<float> too_much(pdf.size(), static_cast<float>(0.26 / std::numbers::pi));
  EXPECT_FALSE(chi2_test(bins.count(samples), bins.expected(too_much, kSamples), kLevel).accepted);
}

TEST_F(Warp, Frames) {
  std::vector<glm::vec4> normals = run(kSphere, 0);
  normals.resize(1 << 14);
  for (glm::vec3 n : {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::vec3(1, 0, 0), glm::vec3(0, -1, 0),
                      glm::vec3(1e-4f, 0, -1), glm::vec3(0.6f, 0.8f, -0.0f)})
    normals.emplace_back(n, 0);
  const std::vector<glm::vec4> axes = run(kFrame, 0, normals);
  for (size_t i = 0; i < normals.size(); ++i) {
    const glm::dvec3 s(axes[3 * i]), t(axes[3 * i + 1]), n(axes[3 * i + 2]);
    ASSERT_EQ(n, glm::dvec3(normals[i]));
    ASSERT_NEAR(glm::dot(s, s), 1, 1e-6);
    ASSERT_NEAR(glm::dot(t, t), 1, 1e-6);
    ASSERT_NEAR(glm::dot(s, t), 0, 4e-7);
    ASSERT_NEAR(glm::dot(s, n), 0, 4e-7);
    ASSERT_NEAR(glm::dot(glm::cross(s, t), n), 1, 1e-6) << "right-handed";
    ASSERT_LT(axes[3 * i].w, 3e-7) << "to_world undoes to_local";
  }
}

}  // namespace
}  // namespace tachylite::test
