// Adaptive sampling: how samples are shared out, and that it has no bias.

#include <gtest/gtest.h>

#include <cmath>

#include "support/pcg32.h"
#include "wavefront/adaptive_sampling.h"

namespace tachylite::test {
namespace {

constexpr uint64_t kBlock = 4;

/// Values of one block of a pixel: rare and bright, the mean is 1.
glm::dvec3 sum_of_rare(Pcg32& random, double probability) {
  double sum = 0;
  for (uint64_t s = 0; s < kBlock; ++s) sum += random.uniform_double() < probability ? 1 / probability : 0;
  return glm::dvec3(sum);
}

/// 8 blocks a pixel; those of pixel `loud` differ widely.
FilmBuffer film_of_noise(int width, int height, uint32_t seed, size_t loud = ~size_t{0}) {
  FilmBuffer film(width, height);
  Pcg32 random(seed);
  for (uint64_t b = 0; b < 8; ++b) {
    for (size_t i = 0; i < film.pixels(); ++i) {
      glm::dvec3 sum = sum_of_rare(random, 0.3);
      if (i == loud) sum = glm::dvec3(b == 0 ? 400 : 0);
      film.add_block(i, sum, kBlock);
    }
    film.finish_blocks({b * kBlock, kBlock});
  }
  return film;
}

TEST(AdaptiveSampling, PilotsArePowersOfTwo) {
  EXPECT_EQ(pilot_samples(1000), 128u);
  EXPECT_EQ(pilot_samples(1024), 256u);
  EXPECT_EQ(pilot_samples(40), 16u);
  EXPECT_EQ(pilot_samples(10), 10u);  // all of them
}

TEST(AdaptiveSampling, PixelsOfTheOtherColourDecide) {
  constexpr int kWidth = 21, kHeight = 15;
  constexpr size_t kLoud = 7 * kWidth + 10;
  const std::vector<float> quiet = sampling_density(film_of_noise(kWidth, kHeight, 1));
  const FilmBuffer film = film_of_noise(kWidth, kHeight, 1, kLoud);
  const std::vector<float> loud = sampling_density(film);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const auto i = static_cast<size_t>(y * kWidth + x);
      const bool decided = std::abs(x - 10) <= 3 && std::abs(y - 7) <= 3 && (x + y) % 2 != 17 % 2;
      if (decided) {
        EXPECT_GT(loud[i], 1.05 * quiet[i]) << x << " " << y;
      }
      if ((x + y) % 2 == 17 % 2) {
        EXPECT_EQ(loud[i], quiet[i]) << x << " " << y;
      }
    }
}

TEST(AdaptiveSampling, SharesAreInProportion) {
  constexpr int kWidth = 64;
  constexpr uint32_t kLeast = 4, kChunk = 2;
  constexpr double kMean = 20;
  std::vector<float> density(kWidth * kWidth);
  for (size_t i = 0; i < density.size(); ++i) density[i] = static_cast<float>(i % kWidth / 16);  // 0 to 3, and a spike
  density[5] = 1e6f;
  const std::vector<uint32_t> blocks = allocate_blocks(density, kWidth, kLeast, kMean, kChunk);
  double of_density[4] = {}, of_colour[2] = {};
  for (size_t i = 0; i < blocks.size(); ++i) {
    EXPECT_GE(blocks[i], kLeast);
    EXPECT_LE(blocks[i], kLargestShare * kMean);
    EXPECT_EQ((blocks[i] - kLeast) % kChunk, 0u);
    of_colour[(i % kWidth + i / kWidth) % 2] += blocks[i] / (0.5 * kWidth * kWidth);
    if (i != 5) of_density[i % kWidth / 16] += blocks[i] / (16.0 * kWidth);
  }
  for (const double mean : of_colour) EXPECT_NEAR(mean, kMean, 0.1);
  EXPECT_EQ(of_density[0], kLeast * (1 - 1 / (16.0 * kWidth)));
  EXPECT_NEAR(of_density[2] / of_density[1], 2, 0.02);
  EXPECT_NEAR(of_density[3] / of_density[1], 3, 0.03);
}

TEST(AdaptiveSampling, BudgetsGrowMonotonically) {
  std::vector<float> density(48 * 48);
  Pcg32 random(3);
  for (float& d : density) d = static_cast<float>(random.uniform_double());
  std::vector<uint32_t> before(density.size(), 4);
  for (const double mean : {4.0, 5.0, 9.0, 11.0, 40.0, 41.0}) {
    const std::vector<uint32_t> blocks = allocate_blocks(density, 48, 4, mean, 8);
    for (size_t i = 0; i < blocks.size(); ++i) EXPECT_GE(blocks[i], before[i]);
    before = blocks;
  }
}

TEST(AdaptiveSampling, WithoutNoiseAllPixelsAreAlike) {
  const std::vector<uint32_t> blocks = allocate_blocks(std::vector<float>(100, 0.0f), 10, 4, 16, 1);
  for (const uint32_t b : blocks) EXPECT_EQ(b, 16u);
}

/// Mean of all pixels and its standard error, where pixels decide for others (`across`) or each for itself.
std::pair<double, double> mean_after(bool across) {
  constexpr int kSize = 32, kTrials = 40;
  constexpr double kProbability = 1.0 / 64;  // a pilot of 32 samples misses the light in 0.6 of the pixels
  double sum = 0, squares = 0;
  for (uint32_t trial = 0; trial < kTrials; ++trial) {
    FilmBuffer film(kSize, kSize);
    Pcg32 random(trial);
    for (uint64_t b = 0; b < 8; ++b) {
      for (size_t i = 0; i < film.pixels(); ++i) film.add_block(i, sum_of_rare(random, kProbability), kBlock);
      film.finish_blocks({b * kBlock, kBlock});
    }
    std::vector<float> density = sampling_density(film);
    if (!across)
      for (size_t i = 0; i < density.size(); ++i) density[i] = static_cast<float>(std::sqrt(film.variance_of_mean(i).x));
    const std::vector<uint32_t> blocks = allocate_blocks(density, kSize, 8, 32, 1);
    double image = 0;
    for (size_t i = 0; i < film.pixels(); ++i) {
      const uint64_t own = blocks[i] - 8;
      for (uint64_t b = 0; b < own; ++b) film.add_block(i, sum_of_rare(random, kProbability), kBlock);
      film.finish_own_blocks(i, own, own * kBlock);
      image += film.mean(i).x / static_cast<double>(film.pixels());
    }
    sum += image / kTrials;
    squares += image * image / kTrials;
  }
  return {sum, std::sqrt((squares - sum * sum) / (kTrials - 1))};
}

// Level 6e-5 (four standard errors of about 0.4 %): a bias of 3 % is seen with probability 0.99. Pixels that decide
// for themselves are off by half.
TEST(AdaptiveSampling, IsUnbiased) {
  const auto [mean, error] = mean_after(true);
  EXPECT_LT(error, 0.006);
  EXPECT_NEAR(mean, 1, 4 * error);
  const auto [biased, biased_error] = mean_after(false);
  EXPECT_LT(biased, 1 - 20 * biased_error);
}

}  // namespace
}  // namespace tachylite::test
