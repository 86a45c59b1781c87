// The guide's table: path/guide_table.glsl draws from the densities of build_guide, which follow the photons.

#include <bit>
#include <cmath>
#include <random>

#include <glm/gtc/packing.hpp>

#include "shared/bindings.h"
#include "shared/features.h"
#include "shared/guide.h"
#include "support/chi2.h"
#include "support/device_test.h"
#include "wavefront/photon_guide.h"

namespace tachylite::test {
namespace {

using gpu::kGuideBins;
using gpu::kGuideCellBins;

constexpr uint32_t kGuideCellsTested = 4, kGuideSamples = 1 << 18;
const double kGuideLevel = sidak(1e-4, 4);

// No photon; one bin full of them; few; a bright quarter on noise. After these cells comes the uniform one.
std::vector<uint32_t> some_photons() {
  std::mt19937 generator(3);
  std::vector<uint32_t> flux(kGuideCellsTested * kGuideCellBins, 0);
  flux[kGuideCellBins + 37] = 5000 * static_cast<uint32_t>(gpu::kPhotonUnit);
  for (int i = 0; i < 20; ++i) flux[2 * kGuideCellBins + generator() % kGuideCellBins] += 256;
  for (uint32_t b = 0; b < kGuideCellBins; ++b)
    flux[3 * kGuideCellBins + b] = generator() % 2000 + (b % kGuideBins < 8 && b / kGuideBins < 8 ? 20000 : 0);
  return flux;
}

std::vector<glm::uvec2> guide_of(const std::vector<uint32_t>& flux, uint32_t focusers) {
  std::vector<glm::uvec2> guide(flux.size() + kGuideCellBins * (1 + focusers));
  build_guide(flux, focusers, guide);
  return guide;
}

double density_of(const std::vector<glm::uvec2>& guide, uint32_t cell, uint32_t bin) {
  const glm::uvec2 pair = guide[cell * kGuideCellBins + gpu::kGuideDensities + bin / 2];
  return std::bit_cast<float>(bin % 2 == 0 ? pair.x : pair.y);
}

// Probability of a bin by the nodes on the way to it.
double probability_of(const std::vector<glm::uvec2>& guide, uint32_t cell, uint32_t bin) {
  double probability = 1;
  uint32_t node = 0;
  for (uint32_t bit = kGuideBins / 2; bit > 0; bit /= 2) {
    const glm::uvec2 entry = guide[cell * kGuideCellBins + node];
    const bool right = (bin % kGuideBins & bit) != 0, up = (bin / kGuideBins & bit) != 0;
    const double left = entry.x / 65536.0, lower = (right ? entry.y >> 16 : entry.y & 0xffff) / 65536.0;
    probability *= (right ? 1 - left : left) * (up ? 1 - lower : lower);
    node = 4 * node + 1 + (right ? 1 : 0) + (up ? 2 : 0);
  }
  return probability;
}

TEST(PhotonGuide, TreeHasTheDensity) {
  const std::vector<glm::uvec2> guide = guide_of(some_photons(), 0);
  for (uint32_t cell = 1; cell <= kGuideCellsTested; ++cell) {
    double sum = 0;
    for (uint32_t b = 0; b < kGuideCellBins; ++b) {
      sum += density_of(guide, cell, b);
      EXPECT_GE(density_of(guide, cell, b), 0.145);  // so that no weight exceeds 7 times that of the bsdf
      EXPECT_NEAR(kGuideCellBins * probability_of(guide, cell, b) / density_of(guide, cell, b), 1, 1e-6)
          << cell << " " << b;
    }
    EXPECT_NEAR(sum / kGuideCellBins, 1, 1e-6);
  }
}

TEST(PhotonGuide, FollowsPhotonsWhereThereAreMany) {
  const std::vector<glm::uvec2> guide = guide_of(some_photons(), 0);
  // Without any, all samples follow the bsdf alone, and the table after the last cell stands in.
  EXPECT_EQ(guide[gpu::kGuideShares].y >> 16, 0xffff);
  for (uint32_t b = 0; b < kGuideCellBins; ++b) EXPECT_EQ(density_of(guide, kGuideCellsTested, b), 1);
  // 0.85 of the samples; of those 1 / (1 + 4 * 0.2 + 4 * 0.04) in the bin itself.
  EXPECT_NEAR(density_of(guide, 1, 37) / kGuideCellBins, 0.85 / 1.96, 0.01);
  EXPECT_GT(density_of(guide, 3, 0), 2 * density_of(guide, 3, kGuideCellBins - 1));
}

using GuideTable = DeviceTest;

std::vector<glm::vec4> run_guide(const std::vector<glm::uvec2>& guide, uint32_t cell, bool guided) {
  KernelRun kernel("guide");
  kernel.constant(0, guided).push(glm::uvec2(kGuideSamples, cell));
  kernel.texels(gpu::kBindGuide, VK_FORMAT_R32G32_UINT, std::span<const glm::uvec2>(guide));
  kernel.output<glm::vec4>(1, kGuideSamples);
  return kernel.run(kGuideSamples).result<glm::vec4>(1);
}

// In quarters of the bins, so that the numbers must be uniform within a bin, too. 2^18 samples in 1024 of them see a
// density that is off by 3 % (standard deviation) with probability 0.99.
TEST_F(GuideTable, DrawsFromItsDensity) {
  const std::vector<glm::uvec2> guide = guide_of(some_photons(), 0);
  for (uint32_t cell = 1; cell <= kGuideCellsTested; ++cell) {
    constexpr uint32_t kFine = 2 * kGuideBins;
    std::vector<double> observed(kFine * kFine, 0.0), expected(kFine * kFine);
    for (uint32_t i = 0; i < kFine * kFine; ++i) {
      const uint32_t bin = i % kFine / 2 + kGuideBins * (i / kFine / 2);
      expected[i] = kGuideSamples * density_of(guide, cell, bin) / (kFine * kFine);
    }
    for (const glm::vec4& s : run_guide(guide, cell, true)) {
      ASSERT_TRUE(s.x >= 0 && s.x < 1 && s.y >= 0 && s.y < 1);
      const auto x = static_cast<uint32_t>(s.x * kFine), y = static_cast<uint32_t>(s.y * kFine);
      observed[y * kFine + x] += 1;
      ASSERT_NEAR(s.z / density_of(guide, cell, y / 2 * kGuideBins + x / 2), 1, 1e-6);
    }
    const Chi2Result result = chi2_test(observed, expected, kGuideLevel);
    EXPECT_TRUE(result.accepted) << cell << ": " << result.message;
    EXPECT_LT(result.detectable, 0.04);
  }
}

// The density of a direction is that of the numbers that it was sampled with, but for rounding at the borders of bins.
TEST_F(GuideTable, FindsTheBinOfADirection) {
  const std::vector<glm::uvec2> guide = guide_of(some_photons(), 0);
  for (const bool guided : {true, false}) {
    int wrong = 0;
    for (const glm::vec4& s : run_guide(guide, 3, guided)) {
      const auto x = static_cast<uint32_t>(s.x * kGuideBins), y = static_cast<uint32_t>(s.y * kGuideBins);
      const uint32_t bin = x + kGuideBins * y;
      wrong += static_cast<uint32_t>(s.w) != bin || std::abs(s.z / density_of(guide, 3, bin) - 1) > 1e-6;
    }
    EXPECT_LE(wrong, kGuideSamples / 20000);
  }
}

// What focusers send to a cell: one cell of three tables.
std::vector<uint32_t> focused_photons() {
  const std::vector<uint32_t> some = some_photons();
  std::vector<uint32_t> flux(3 * kGuideCellBins, 0);
  std::copy_n(some.begin() + 3 * kGuideCellBins, kGuideCellBins, flux.begin());
  flux[2 * kGuideCellBins + 100] = 500 * static_cast<uint32_t>(gpu::kPhotonUnit);
  return flux;
}

TEST(PhotonGuide, FocusersHaveTheShareOfTheirLight) {
  const std::vector<uint32_t> flux = focused_photons();
  const std::vector<glm::uvec2> guide = guide_of(flux, 2);
  double own = 0;
  for (size_t b = 0; b < kGuideCellBins; ++b) own += flux[b] / double{gpu::kPhotonUnit};
  const glm::vec2 first = glm::unpackUnorm2x16(guide[gpu::kGuideShares].x);
  const glm::vec2 second = glm::unpackUnorm2x16(guide[gpu::kGuideShares].y);
  const double guided = 0.85 * (own + 500) / (own + 516);
  EXPECT_EQ(first.x, 0);
  EXPECT_NEAR(first.y, guided * 500 / (own + 500), 1e-4);
  EXPECT_EQ(second.x, 0);
  EXPECT_NEAR(second.y, 1 - guided, 1e-4);
  // The cell's own table has what is uniform: with its share of the samples it never has less than 0.15 of them.
  for (uint32_t b = 0; b < kGuideCellBins; ++b) EXPECT_GE((1 - first.y) * density_of(guide, 0, b), 0.145);
  EXPECT_GT(density_of(guide, 2, 100), 50);
}

std::vector<glm::vec4> run_focus(const glm::vec4& sphere, uint32_t mode) {
  KernelRun kernel("focus_cone");
  kernel.constant(100, mode).constant(gpu::kFeatureFocusers, gpu::kMaxFocusers).push(sphere);
  kernel.output<glm::vec4>(1, kGuideSamples);
  return kernel.run(kGuideSamples).result<glm::vec4>(1);
}

const glm::vec4 kSpheres[] = {{0.3f, 2, -1, 0.5f}, {-4, 0.1f, 0, 0.01f}, {0.2f, 0.9f, 0.8f, 1}, {0, 0, -3, 0.4f}};

// Directions come back to the numbers that they were made of.
TEST_F(GuideTable, ConesHaveAnInverse) {
  for (const glm::vec4& sphere : kSpheres)
    for (const glm::vec4& s : run_focus(sphere, 0)) {
      ASSERT_NEAR(s.x, s.z, 2e-4) << sphere.w;
      ASSERT_NEAR(s.y, s.w, 2e-4) << sphere.w;
    }
}

// Uniform directions of the sphere, by their numbers: uniform in the square, as many as its density says. 2^18 of which
// a part falls into the cone; of the wide ones 64 bins see a density that is off by 3 %.
TEST_F(GuideTable, ConesKeepSolidAngle) {
  for (const glm::vec4& sphere : {kSpheres[0], kSpheres[2], kSpheres[3]}) {
    std::vector<double> observed(65, 0.0), expected(65);
    double pdf = 0;
    for (const glm::vec4& s : run_focus(sphere, 1)) {
      pdf = s.z;
      const bool inside = s.w != 0;
      observed[inside ? static_cast<size_t>(std::min(7.f, 8 * s.y)) * 8 + static_cast<size_t>(std::min(7.f, 8 * s.x)) : 64] += 1;
    }
    const double share = 1 / (4 * 3.14159265358979323846 * pdf);
    for (size_t i = 0; i < 64; ++i) expected[i] = kGuideSamples * share / 64;
    expected[64] = kGuideSamples * (1 - share);
    const Chi2Result result = chi2_test(observed, expected, kGuideLevel);
    EXPECT_TRUE(result.accepted) << result.message;
    EXPECT_LT(result.detectable, 0.08);
  }
}

// By shares 0.3, 0 and 0.45 of sphere.xyz: how often each is taken, and that numbers are uniform after it.
TEST_F(GuideTable, ChoosesFocusersByTheirShares) {
  for (const glm::vec3& shares : {glm::vec3(0.3f, 0, 0.45f), glm::vec3(0.1f, 0.3f, 0.5f), glm::vec3(0)}) {
    const double probabilities[4] = {shares.x, shares.y, shares.z, 1 - double{shares.x} - shares.y - shares.z};
    std::vector<double> observed(64, 0.0), expected(64);
    for (const glm::vec4& s : run_focus(glm::vec4(shares, 0), 2)) {
      ASSERT_TRUE(s.y >= 0 && s.y < 1);
      observed[static_cast<size_t>(s.x) * 16 + static_cast<size_t>(16 * s.y)] += 1;
    }
    std::vector<double> seen, wanted;
    for (size_t i = 0; i < 64; ++i) {
      if (probabilities[i / 16] < 1e-6) {
        EXPECT_EQ(observed[i], 0);
        continue;
      }
      seen.push_back(observed[i]);
      wanted.push_back(kGuideSamples * probabilities[i / 16] / 16);
    }
    const Chi2Result result = chi2_test(seen, wanted, kGuideLevel);
    EXPECT_TRUE(result.accepted) << result.message;
    EXPECT_LT(result.detectable, 0.03);
  }
}

}  // namespace
}  // namespace tachylite::test
