// The tests of `compare`: level and power on images of synthetic noise. Level: over kTrials pairs with equal
// expectations the number of rejections must not exceed the 0.9999 quantile of Binomial(kTrials, level).
// Power: a bias of the size that the test itself calls detectable (with probability 0.95) is found in at
// least 85 % of 100 trials; under 0.95 fewer than that happen with a probability below 1e-3.
#include "image/compare.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <boost/math/distributions/binomial.hpp>

#include "base/error.h"

namespace tachylite {
namespace {

constexpr int kSize = 48;
constexpr int kTrials = 300;

struct Noise {
  double deviation = 0.2;  // of the mean of one block of samples, relative to the pixel
  double shape = 1e9;      // of a gamma distribution: 1e9 is as good as normal, 0.05 has a heavy tail
  int blocks = 4;
  double overestimate = 1;     // of the variance layer
  double rare = 0, spike = 0;  // a block is lit with probability `rare` by spike / rare, and its mean keeps
};

double expectation(int x, int y, int channel) {
  return (channel == 0 ? 1.0 : channel == 1 ? 0.4 : 0.02) * (0.2 + x * 0.02) * (1 + 0.5 * std::sin(0.4 * y));
}

/// An image of noise around expectation * factor(x, y), with variance layers from its own blocks.
using Factor = std::function<double(int x, int y)>;
Image noisy_image(std::mt19937& random, const Noise& noise, const Factor& factor, int size = kSize) {
  Image image;
  image.width = image.height = size;
  for (const char* name : {"R", "G", "B", "variance.R", "variance.G", "variance.B"}) image.add(name);
  std::normal_distribution<double> normal;
  std::gamma_distribution<double> gamma(noise.shape, 1);
  std::uniform_real_distribution<double> uniform;
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < size * size; ++i) {
      const double mean = expectation(i % size, i / size, c) * factor(i % size, i / size);
      double sum = 0, square = 0;
      for (int block = 0; block < noise.blocks; ++block) {
        const double deviate =
            noise.shape > 1e6 ? normal(random) : (gamma(random) - noise.shape) / std::sqrt(noise.shape);
        double value = mean * (1 + noise.deviation * deviate);
        if (noise.rare > 0)
          value += mean * noise.spike * ((uniform(random) < noise.rare ? 1 / noise.rare : 0) - 1);
        sum += value, square += value * value;
      }
      const double n = noise.blocks, scatter = std::max(0.0, square - sum * sum / n);
      image.channels[static_cast<size_t>(c)][static_cast<size_t>(i)] = static_cast<float>(sum / n);
      image.channels[static_cast<size_t>(c + 3)][static_cast<size_t>(i)] =
          static_cast<float>(noise.overestimate * scatter / (n - 1) / n);
    }
  }
  return image;
}
Image noisy_image(std::mt19937& random, const Noise& noise, double factor = 1, int size = kSize) {
  return noisy_image(random, noise, Factor([factor](int, int) { return factor; }), size);
}

Comparison compare(const Image& a, const Image& b) {
  return compare_images(a, b, layer_variance(a, b));
}

void expect_level(const Noise& a, const Noise& b, int size = kSize) {
  std::mt19937 random(7);
  const double level = ZTestOptions{}.level;
  int rejected = 0;
  for (int trial = 0; trial < kTrials; ++trial)
    rejected += !compare(noisy_image(random, a, 1, size), noisy_image(random, b, 1, size)).agree();
  const double most = quantile(complement(boost::math::binomial(kTrials, level), 1e-4));
  EXPECT_LE(rejected, most);
}

TEST(CompareLevel, NormalNoise) {
  expect_level({}, {});
}
TEST(CompareLevel, SkewedNoise) {
  expect_level({0.5, 0.05}, {0.5, 0.05});
}
TEST(CompareLevel, SkewedNoiseAgainstLessNoise) {
  expect_level({0.5, 0.05}, {0.1, 0.05, 16});
}
TEST(CompareLevel, TwoBlocksOnly) {
  expect_level({0.3, 0.2, 2}, {0.3, 0.2, 2});
}
TEST(CompareLevel, OverestimatedLayers) {
  expect_level({0.05, 1, 8, 10}, {0.3, 0.2, 8});
}
TEST(CompareLevel, RareBrightPaths) {
  expect_level({0.2, 1, 8, 1, 1e-3, 0.1}, {0.2, 1, 8, 1, 1e-3, 0.1});
}
TEST(CompareLevel, SmallImage) {
  expect_level({0.3, 0.2}, {0.3, 0.2}, 12);
}

Image without_layers(Image image) {
  image.names.resize(3);
  image.channels.resize(3);
  return image;
}

TEST(CompareLevel, LayersInOneImageOnly) {
  std::mt19937 random(41);
  int rejected = 0;
  for (int trial = 0; trial < 200; ++trial)
    rejected +=
        !compare(noisy_image(random, {0.1, 0.2, 8}), without_layers(noisy_image(random, {0.2, 0.2, 8})))
             .agree();
  EXPECT_LE(rejected, 9);  // Binomial(200, 0.01) exceeds it with probability 3e-5
}

TEST(CompareLevel, ExactSampleVariance) {
  std::mt19937 random(3);
  Image variance = noisy_image(random, {}), reference = variance;
  const Noise noise{0.3, 1, 16};
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < variance.channels[c].size(); ++i) {
      const double mean =
          expectation(static_cast<int>(i) % kSize, static_cast<int>(i) / kSize, static_cast<int>(c));
      reference.channels[c][i] = static_cast<float>(mean);
      variance.channels[c][i] = static_cast<float>(mean * mean * noise.deviation * noise.deviation);
    }
  }
  int rejected = 0;
  for (int trial = 0; trial < 100; ++trial)
    rejected += !compare_images(noisy_image(random, noise), reference, sample_variance(variance, 16)).agree();
  EXPECT_LE(rejected, 6);  // Binomial(100, 0.01) exceeds it with probability 6e-5
  EXPECT_FALSE(
      compare_images(noisy_image(random, noise, 1.02), reference, sample_variance(variance, 16)).agree());
}

TEST(ComparePower, BiasOfTheMeanOnePercent) {
  std::mt19937 random(11);
  int found = 0;
  double detectable = 0;
  for (int trial = 0; trial < 100; ++trial) {
    // As an Owen-sampled render against a reference of independent samples: layers of the first ten times too
    // large.
    const Comparison c =
        compare(noisy_image(random, {0.05, 1, 8, 10}, 1.01), noisy_image(random, {0.25, 0.5, 16}));
    found += !c.test->means_agree;
    detectable += c.test->means[0].detectable / 100;
  }
  EXPECT_LT(detectable, 0.01);
  EXPECT_GE(found, 95);
}

TEST(ComparePower, TheStatedBiasOfTheMean) {
  std::mt19937 random(13);
  const Noise noise{0.5, 0.2, 8};
  double stated = 0;  // of the channel R alone
  for (int trial = 0; trial < 20; ++trial)
    stated += compare(noisy_image(random, noise), noisy_image(random, noise)).test->means[0].detectable / 20;
  int found = 0;
  const double alpha = 1 - std::pow(1 - 0.01, 1.0 / 9);  // three tests, three channels
  for (int trial = 0; trial < 100; ++trial)
    found +=
        compare(noisy_image(random, noise, 1 + stated), noisy_image(random, noise)).test->means[0].p < alpha;
  EXPECT_GE(found, 85);
  EXPECT_GT(stated, 0.005);
  EXPECT_LT(stated, 0.1);
}

TEST(ComparePower, TheStatedBiasOfABlock) {
  std::mt19937 random(17);
  const Noise noise{0.2, 1, 8};
  const double stated =
      compare(noisy_image(random, noise), noisy_image(random, noise)).test->blocks.detectable;
  const auto in_one_block = [&](int x, int y) { return x / 8 == 2 && y / 8 == 3 ? 1 + 1.1 * stated : 1.0; };
  int found = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const ZTest test = *compare(noisy_image(random, noise, in_one_block), noisy_image(random, noise)).test;
    found += !test.blocks_agree && test.blocks.x == 16 && test.blocks.y == 24;
  }
  EXPECT_GE(found, 85);
  EXPECT_LT(stated, 0.2);
}

TEST(ComparePower, LocalBiasThatTheMeanHides) {
  std::mt19937 random(19);
  const auto brighter_and_darker = [](int x, int) { return x < kSize / 2 ? 1.1 : 0.9; };
  const ZTest test =
      *compare(noisy_image(random, {0.1, 1, 16}, brighter_and_darker), noisy_image(random, {0.1, 1, 16}))
           .test;
  EXPECT_FALSE(test.blocks_agree);
}

TEST(ComparePower, LayersInOneImageOnly) {
  std::mt19937 random(43);
  const Noise noise{0.1, 1, 16};
  const auto half = [](int x, int) { return x < kSize / 2 ? 1.1 : 0.9; };
  for (int trial = 0; trial < 20; ++trial) {
    const Image judge = without_layers(noisy_image(random, noise));
    EXPECT_FALSE(compare(noisy_image(random, noise, 1.01), judge).test->means_agree);
    EXPECT_FALSE(compare(noisy_image(random, noise, half), judge).test->blocks_agree);
  }
}

TEST(ComparePower, FewWrongPixels) {
  std::mt19937 random(23);
  const auto line = [](int x, int) { return x == 20 ? 1.6 : 1.0; };
  EXPECT_FALSE(compare(noisy_image(random, {0.02, 1, 16}, line), noisy_image(random, {0.02, 1, 16})).agree());
}

TEST(Compare, FiguresOfKnownImages) {
  Image a, b;
  a.width = b.width = 2;
  a.height = b.height = 1;
  for (const char* name : {"R", "G", "B"}) {
    a.add(name) = {1, 3};
    b.add(name) = {2, 2};
  }
  const Comparison c = compare_images(a, b, std::nullopt);
  EXPECT_DOUBLE_EQ(c.channels[0].ratio, 1);
  EXPECT_DOUBLE_EQ(c.mse, 1);
  EXPECT_DOUBLE_EQ(c.epsilon, 0.04);
  EXPECT_DOUBLE_EQ(c.rel_mse, 1 / 4.04);
  EXPECT_DOUBLE_EQ(c.channels[2].largest, 1);
  EXPECT_FALSE(c.test);
  EXPECT_TRUE(c.agree());
}

TEST(Compare, EqualImagesAgreeAndTinyDifferencesAreRounding) {
  std::mt19937 random(29);
  Image a = noisy_image(random, {});
  for (size_t c = 3; c < 6; ++c) std::fill(a.channels[c].begin(), a.channels[c].end(), 0.0f);
  Image b = a;
  EXPECT_TRUE(compare(a, b).agree());
  for (size_t c = 0; c < 3; ++c)
    for (float& v : b.channels[c]) v *= 1.0005f;
  EXPECT_TRUE(compare(a, b).agree());
  for (size_t c = 0; c < 3; ++c)
    for (float& v : b.channels[c]) v *= 1.005f;
  EXPECT_FALSE(compare(a, b).agree());
}

TEST(Compare, BlackImagesAgree) {
  Image a;
  a.width = a.height = 16;
  for (const char* name : {"R", "G", "B", "variance.R", "variance.G", "variance.B"}) a.add(name);
  EXPECT_TRUE(compare(a, a).agree());
  Image lit = a;
  lit.channels[0][5] = 1;
  EXPECT_FALSE(compare(lit, a).agree());
}

TEST(Compare, NonFiniteValuesNeverAgree) {
  std::mt19937 random(31);
  const Image good = noisy_image(random, {});
  for (const float value :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (size_t channel : {0, 4}) {
      Image bad = good;
      bad.channels[channel][100] = value;
      const Comparison c = compare(bad, good);
      EXPECT_EQ(c.nonfinite, 1u);
      EXPECT_FALSE(c.agree());
      EXPECT_TRUE(std::isfinite(c.mse));
    }
  }
}

TEST(Compare, RefusesWhatDoesNotFit) {
  std::mt19937 random(37);
  const Image a = noisy_image(random, {}), small = noisy_image(random, {}, 1, 8);
  EXPECT_THROW(compare(a, small), InputError);
  EXPECT_THROW(compare_images(a, a, layer_variance(small, small)), InputError);
  Image depth;
  depth.width = depth.height = kSize;
  depth.add("Z");
  EXPECT_THROW(compare(a, depth), InputError);
}

}  // namespace
}  // namespace tachylite
