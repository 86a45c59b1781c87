// shared/rng.h and shared/sampler.h: the same bits in both languages, nets in every prefix and every group,
// an index permutation that converges, no correlation between groups, pixels and seeds.

#include "shared/sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "support/device_test.h"

namespace tachylite::gpu {
namespace {

std::vector<uvec4> random_keys(size_t count) {
  std::mt19937 generator(1);
  std::vector<uvec4> keys(count);
  for (uvec4& key : keys) {
    // Indices of all lengths; few groups, so that vertices below and above kFirstHashedVertex occur.
    key = {generator() % 1000000u, generator(), generator() >> (8 + generator() % 24), generator() % 60};
  }
  return keys;
}

class SamplerDevice : public test::DeviceTest {};

TEST_F(SamplerDevice, HasTheHostsBits) {
  const std::vector<uvec4> keys = random_keys(1 << 14);
  for (uint kind : {kSamplerSobol, kSamplerIndependent, 2u}) {
    const auto bits = test::map_kernel<uvec4>("sampler", std::span<const uvec4>(keys), {{0, kind}, {1, 24}});
    for (size_t i = 0; i < keys.size(); ++i) {
      const uvec4 key = keys[i];
      const uvec4 expected =
          kind == 2 ? uvec4(hash_pcg(key.x), hash_pair(key.x, key.y), std::bit_cast<uint>(unit_float(key.z)),
                            permute_index(key.z, key.x)) +
                          hash_pcg4d(key)
                    : sample_group(kind, pixel_key(key.x, key.y), key.z, key.w, 24);
      ASSERT_EQ(bits[i], expected) << "kind " << kind << " key " << key.x << " " << key.y << " " << key.z
                                   << " " << key.w;
    }
  }
}

TEST(Sampler, UnitFloatsStayBelowOne) {
  EXPECT_EQ(unit_float(0), 0.0f);
  EXPECT_EQ(unit_float(0xffffffffu), 1.0f - 0x1p-24f);
  EXPECT_EQ(unit_float(0x80000000u), 0.5f);
}

TEST(Sampler, IndexBits) {
  EXPECT_EQ(sample_index_bits(0), 0u);
  EXPECT_EQ(sample_index_bits(1), 0u);
  EXPECT_EQ(sample_index_bits(2), 1u);
  EXPECT_EQ(sample_index_bits(64), 6u);
  EXPECT_EQ(sample_index_bits(65), 7u);
}

// A longer loop must not change the samples, or images of parts could not be merged.
TEST(Sampler, NumbersDoNotDependOnBits) {
  for (const uvec4 key : random_keys(2000)) {
    const uint pixel = pixel_key(key.x, key.y);
    EXPECT_EQ(sample_group(kSamplerSobol, pixel, key.z, key.w, sample_index_bits(key.z + 1)),
              sample_group(kSamplerSobol, pixel, key.z, key.w, 24));
  }
}

/// The quality parameter t of the first 2^m points in dimensions (a, b): every box of area 2^(t - m) whose
/// sides are dyadic holds 2^t points.
uint quality(const std::vector<uvec4>& points, uint m, int a, int b) {
  for (uint t = 0; t <= m; ++t) {
    bool net = true;
    for (uint split = 0; split <= m - t && net; ++split) {
      const uint other = m - t - split;
      std::vector<uint> counts(size_t{1} << (m - t));
      for (size_t i = 0; i < (size_t{1} << m); ++i) {
        const uint x = split ? points[i][a] >> (32 - split) : 0, y = other ? points[i][b] >> (32 - other) : 0;
        net = net && ++counts[(size_t{x} << other) + y] <= (1u << t);
      }
    }
    if (net) return t;
  }
  return m;
}

TEST(Sampler, EveryPrefixOfEveryGroupIsANet) {
  // t of the unscrambled Sobol sequence for m = 0, 1, 2, ..., of dimensions (0, 1) and (2, 3): rank
  // computations.
  constexpr uint kBits = 11;
  constexpr uint kQuality23[kBits + 1] = {0, 0, 1, 2, 0, 1, 1, 1, 1, 1, 1, 2};
  for (uint seed = 0; seed < 4; ++seed) {
    for (uint group : {kGroupCamera, kGroupLens, group_directions(0), group_choices(3), group_medium(7)}) {
      std::vector<uvec4> points;
      for (uint i = 0; i < (1u << kBits); ++i)
        points.push_back(sample_group(kSamplerSobol, pixel_key(17 * seed, seed), i, group, kBits));
      for (uint m = 0; m <= kBits; ++m) {
        EXPECT_EQ(quality(points, m, 0, 1), 0u) << "m " << m << " group " << group;
        EXPECT_EQ(quality(points, m, 2, 3), kQuality23[m]) << "m " << m << " group " << group;
        for (int dimension = 0; dimension < 4; ++dimension) {
          std::vector<bool> taken(size_t{1} << m);
          for (size_t i = 0; i < taken.size(); ++i) taken[m ? points[i][dimension] >> (32 - m) : 0] = true;
          EXPECT_EQ(std::count(taken.begin(), taken.end(), false), 0)
              << "m " << m << " dimension " << dimension;
        }
      }
    }
  }
}

// Owen permutation: [0, 2^k) maps to itself; blocks of 2^k map to blocks; and whether the halves of a block
// are swapped is a fair coin, independent from block to block.
TEST(Sampler, IndexPermutationIsNestedAndRandom) {
  constexpr uint kBits = 6, kSeeds = 4000;
  std::vector<double> flips(1 << kBits), pairs(size_t{1} << (2 * kBits));
  for (uint seed = 0; seed < kSeeds; ++seed) {
    const uint key = hash_pcg(seed);
    std::vector<int> flip(
        1 << kBits);  // of the node 2^level + prefix, the block of 2^(kBits - level) indices
    for (uint level = 0; level < kBits; ++level) {
      for (uint prefix = 0; prefix < (1u << level); ++prefix) {
        const uint first = prefix << (kBits - level), half = 1u << (kBits - level - 1);
        const uint target = permute_index(first, key) >> (kBits - level);
        for (uint i = 0; i < 2 * half; ++i)
          ASSERT_EQ(permute_index(first + i, key) >> (kBits - level), target);
        flip[(1u << level) + prefix] = (permute_index(first, key) / half) & 1;
      }
    }
    for (size_t i = 1; i < flip.size(); ++i) {
      flips[i] += flip[i];
      for (size_t j = 1; j < i; ++j) pairs[(i << kBits) + j] += flip[i] != flip[j];
    }
  }
  // Two-sided z-tests of fair coins; Sidak over all of them at level 1e-3: |z| < 5.6 for about 1700 tests.
  // The power to see a bias of 0.06 in one of them is 0.99.
  const double bound = 5.0;
  const auto z = [&](double count) { return (count - 0.5 * kSeeds) / (0.5 * std::sqrt(double{kSeeds})); };
  for (size_t i = 1; i < flips.size(); ++i) {
    const bool zero_spine = std::has_single_bit(i);  // nodes that hold index 0: never swapped
    if (zero_spine) {
      EXPECT_EQ(flips[i], 0);
      continue;
    }
    EXPECT_LT(std::abs(z(flips[i])), bound) << "node " << i;
    for (size_t j = 1; j < i; ++j)
      if (!std::has_single_bit(j)) {
        EXPECT_LT(std::abs(z(pairs[(i << kBits) + j])), bound) << i << " " << j;
      }
  }
}

/// Mean over pixels of the squared error of the mean of f(x of one group, x of another) over n samples.
template <class Sample>
double padded_error(uint n, Sample sample) {
  constexpr uint kPixels = 300;
  double error = 0;
  for (uint pixel = 0; pixel < kPixels; ++pixel) {
    double sum = 0;
    for (uint i = 0; i < n; ++i) {
      const double x = static_cast<double>(unit_float(sample(pixel, i, 0u).x));
      const double y = static_cast<double>(unit_float(sample(pixel, i, 1u).x));
      sum += (x < 0.37) != (y < 0.61);  // mean 0.37 * 0.39 + 0.63 * 0.61
    }
    const double difference = sum / n - (0.37 * 0.39 + 0.63 * 0.61);
    error += difference * difference / kPixels;
  }
  return error;
}

// The error of a product over two padded groups falls like 1 / n; where the index is only XORed, it stays.
TEST(Sampler, PaddedGroupsConverge) {
  constexpr uint kSamples = 1024;
  const double independent = 0.2488 / kSamples;  // p (1 - p) / n
  const double sobol = padded_error(kSamples, [](uint pixel, uint i, uint group) {
    return sample_group(kSamplerSobol, pixel_key(pixel, 1), i, group, 10);
  });
  const double by_xor = padded_error(kSamples, [](uint pixel, uint i, uint group) {
    const uint seed = hash_pair(pixel_key(pixel, 1), group);
    const uvec4 x = sobol_reversed((i ^ seed) & (kSamples - 1), 10);
    return uvec4(reverse_bits(scramble_reversed(x.x, hash_pcg(seed + 1))), 0, 0, 0);
  });
  // Relative standard deviation of a mean of 300 squares of normals: 0.08; so the level is below 1e-6 on each
  // side.
  EXPECT_LT(sobol, 1.4 * independent);
  EXPECT_GT(by_xor, 10 * independent) << "this test would not see a permutation that does not converge";
}

TEST(Sampler, NoCorrelationBetweenGroupsPixelsAndSeeds) {
  constexpr uint kPixels = 20000;
  constexpr double kBound =
      5.2;  // Sidak over 4 x 4 x 4 x 3 x 2 tests at level 1e-4: 5.2; power 0.99 for |r| > 0.055
  for (uint kind : {kSamplerSobol, kSamplerIndependent}) {
    const auto draw = [&](uint pixel, uint seed, uint index, uint group) {
      return sample_group(kind, pixel_key(pixel, seed), index, group, 4);
    };
    for (uint index : {0u, 1u, 5u}) {
      double sums[4][4][4] = {};
      for (uint pixel = 0; pixel < kPixels; ++pixel) {
        const uvec4 here = draw(pixel, 3, index, group_directions(1));
        const uvec4 others[4] = {
            draw(pixel + 1, 3, index, group_directions(1)), draw(pixel, 4, index, group_directions(1)),
            draw(pixel, 3, index, group_choices(1)), draw(pixel, 3, index, group_directions(2))};
        for (int other = 0; other < 4; ++other)
          for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b)
              sums[other][a][b] += (static_cast<double>(unit_float(here[a])) - 0.5) *
                                   (static_cast<double>(unit_float(others[other][b])) - 0.5);
      }
      for (int other = 0; other < 4; ++other)
        for (int a = 0; a < 4; ++a)
          for (int b = 0; b < 4; ++b)  // under independence: mean 0, variance 1/144 a pixel
            EXPECT_LT(std::abs(sums[other][a][b] * 12 / std::sqrt(double{kPixels})), kBound)
                << "kind " << kind << " index " << index << " other " << other << " dimensions " << a << b;
    }
  }
}

// One sample of many pixels is uniform in every 2D projection: a chi2 test of 16 x 16 bins.
TEST(Sampler, PixelsAreUniform) {
  constexpr uint kPixels = 1 << 15, kBins = 16;
  for (uint kind : {kSamplerSobol, kSamplerIndependent})
    for (uint index : {0u, 3u})
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < a; ++b) {
          std::vector<double> counts(kBins * kBins);
          for (uint pixel = 0; pixel < kPixels; ++pixel) {
            const uvec4 x = sample_group(kind, pixel_key(pixel, 9), index, kGroupCamera, 2);
            ++counts[(x[a] >> 28) * kBins + (x[b] >> 28)];
          }
          const double expected = double{kPixels} / (kBins * kBins);
          double chi2 = 0;
          for (double count : counts) chi2 += (count - expected) * (count - expected) / expected;
          // 255 degrees of freedom: P(chi2 > 376) = 1e-6 a test, 24 tests. Power 0.99 for densities with a
          // relative standard deviation of 0.09 between bins.
          EXPECT_LT(chi2, 376) << "kind " << kind << " index " << index << " dimensions " << a << b;
        }
}

}  // namespace
}  // namespace tachylite::gpu
