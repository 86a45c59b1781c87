// verify() with two synthetic renderers whose noise falls with the number of samples.
#include "image/verify.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace tachylite {
namespace {

constexpr int kSize = 64;

/// Independent samples of standard deviation `deviation` (relative) around a gradient times 1 + bias(x, y).
struct FakeRenderer {
  std::mt19937 random;
  double deviation = 1;
  std::function<double(int, int)> bias = [](int, int) { return 0.0; };
  int rounds = 0;

  std::optional<Image> operator()(uint64_t samples, int) {
    ++rounds;
    Image image;
    image.width = image.height = kSize;
    for (const char* name : {"R", "G", "B", "variance.R", "variance.G", "variance.B"}) image.add(name);
    const double sigma = deviation / std::sqrt(static_cast<double>(samples));
    // A variance estimated from `samples` samples has about samples - 1 degrees of freedom.
    std::gamma_distribution<double> chi2(0.5 * static_cast<double>(samples - 1),
                                         2.0 / static_cast<double>(samples - 1));
    std::normal_distribution<double> normal;
    for (size_t c = 0; c < 3; ++c) {
      for (int i = 0; i < kSize * kSize; ++i) {
        const double mean = (0.3 + 0.01 * (i % kSize)) * (1 + bias(i % kSize, i / kSize));
        image.channels[c][static_cast<size_t>(i)] = static_cast<float>(mean * (1 + sigma * normal(random)));
        image.channels[c + 3][static_cast<size_t>(i)] =
            static_cast<float>(mean * mean * sigma * sigma * chi2(random));
      }
    }
    return image;
  }
};

Verification::Verdict verdict_with(unsigned seed, const std::function<double(int, int)>& bias) {
  FakeRenderer tested{std::mt19937(seed), 0.5, bias}, judge{std::mt19937(seed + 1000), 1};
  return verify(std::ref(tested), std::ref(judge), {}).verdict;
}

TEST(Verify, EqualExpectationsAgree) {
  for (unsigned seed = 0; seed < 20; ++seed)
    EXPECT_EQ(verdict_with(seed, [](int, int) { return 0.0; }), Verification::Verdict::kAgree);
}

// Power of a bias at the stated size: 0.95 for the first look and again for the confirmation, so 0.9; fewer
// than 14 of 20 happen then with a probability of 2.4e-3, and for the bias of 1.5 % used here far below 1e-6.
TEST(Verify, FindsBiasOfTheMean) {
  int found = 0;
  for (unsigned seed = 0; seed < 20; ++seed)
    found += verdict_with(seed, [](int, int) { return 0.015; }) == Verification::Verdict::kDiffer;
  EXPECT_GE(found, 19);
}

TEST(Verify, FindsBiasOfOneBlock) {
  int found = 0;
  for (unsigned seed = 0; seed < 20; ++seed)
    found += verdict_with(seed, [](int x, int y) { return x / 8 == 3 && y / 8 == 5 ? 0.15 : 0.0; }) ==
             Verification::Verdict::kDiffer;
  EXPECT_GE(found, 19);
}

TEST(Verify, EndsEarlyWhereTheDifferenceIsPlain) {
  FakeRenderer tested{std::mt19937(1), 1, [](int, int) { return 0.5; }}, judge{std::mt19937(2), 1};
  const Verification result = verify(std::ref(tested), std::ref(judge), {});
  EXPECT_EQ(result.verdict, Verification::Verdict::kDiffer);
  EXPECT_EQ(tested.rounds, 1);
  EXPECT_EQ(result.samples, VerifyOptions{}.first_samples);
}

TEST(Verify, NoVerdictWithoutPower) {
  FakeRenderer tested{std::mt19937(1), 30}, judge{std::mt19937(2), 30};
  VerifyOptions options;
  options.most_samples = 64;
  const Verification result = verify(std::ref(tested), std::ref(judge), options);
  EXPECT_EQ(result.verdict, Verification::Verdict::kOpen);
  EXPECT_EQ(result.samples, 64u);
}

TEST(Verify, NoVerdictWhenInterrupted) {
  FakeRenderer tested{std::mt19937(1), 1};
  const auto nothing = [](uint64_t, int) { return std::optional<Image>(); };
  EXPECT_EQ(verify(std::ref(tested), nothing, {}).verdict, Verification::Verdict::kOpen);
  EXPECT_EQ(verify(nothing, std::ref(tested), {}).verdict, Verification::Verdict::kOpen);
}

TEST(Verify, CombinedEstimatesAreWeightedBySamples) {
  Image a, b;
  a.width = a.height = b.width = b.height = 1;
  for (const char* name : {"R", "G", "B", "variance.R", "variance.G", "variance.B"}) {
    a.add(name) = {1};
    b.add(name) = {5};
  }
  const Image c = combine_estimates(a, 30, b, 10);
  EXPECT_FLOAT_EQ((*c.find("G"))[0], 2);
  EXPECT_FLOAT_EQ((*c.find("variance.G"))[0], 0.75f * 0.75f + 5 * 0.25f * 0.25f);
}

}  // namespace
}  // namespace tachylite
