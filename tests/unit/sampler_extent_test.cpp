// shared/sampler.h to its last index, 2^24 - 1: nets of all sizes up to 2^24 points, which do not repeat. And whether
// pixels, seeds, groups and dimensions know of each other in ways that a correlation (kernels/sampler_test.cpp) does
// not see: chi2 of pairs.

#include "shared/sampler.h"

#include <array>
#include <cstdlib>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace tachylite::gpu {
namespace {

constexpr uint kFirstNet = 10;

/// Two dimensions, and the quality t of the nets that their points are. A dimension whose primitive polynomial has
/// degree e adds e - 1 (Sobol 1967, "On the distribution of points in a cube and the approximate evaluation of
/// integrals", theorem 3.3): dimensions 0 and 1 add nothing, 2 and 3 one and two.
struct Pair {
  int x, y;
  uint quality;
};
constexpr Pair kPairs[] = {{0, 1, 0}, {0, 2, 1}, {1, 2, 1}, {0, 3, 2}, {1, 3, 2}, {2, 3, 3}};

/// Of the first 2^size points, those in boxes that have enough without them. The boxes have the area
/// 2^(quality - size), 2^split of them lie along x: in a net, each has 2^quality points.
size_t too_many(const std::vector<uvec4>& points, const Pair& pair, uint size, uint split,
                std::vector<uint8_t>& counts) {
  const uint other = size - pair.quality - split;
  counts.assign(size_t{1} << (size - pair.quality), 0);
  size_t many = 0;
  for (size_t i = 0; i < size_t{1} << size; ++i) {
    const uint64_t x = points[i][pair.x], y = points[i][pair.y];
    const uint64_t column = x >> (32 - split), row = y >> (32 - other);
    many += ++counts[(column << other) + row] > 1u << pair.quality;
  }
  return many;
}

std::vector<uvec4> draw(uint pixel, uint group, size_t count, const std::function<uint(uint)>& index) {
  std::vector<uvec4> points(count);
  for (uint i = 0; i < count; ++i) points[i] = sample_group(kSamplerSobol, pixel, index(i), group, kMaxSampleBits);
  return points;
}

/// The first 2^10, 2^11 ... points: all pairs of dimensions, boxes of all shapes. And each dimension alone.
void expect_nets(const std::vector<uvec4>& points, const std::string& name) {
  std::vector<uint8_t> counts;
  for (uint size = kFirstNet; points.size() >> size; ++size) {
    for (const Pair& pair : kPairs)
      for (uint split = 0; split <= size - pair.quality; ++split)
        EXPECT_EQ(too_many(points, pair, size, split, counts), 0u)
            << "2^" << size << " points, 2^" << split << " columns, dimensions " << pair.x << pair.y << ", " << name;
    for (const int d : {2, 3})
      EXPECT_EQ(too_many(points, {d, d, 0}, size, size, counts), 0u)
          << "2^" << size << " points, dimension " << d << ", " << name;
  }
}

constexpr uint kPoints = 1u << kMaxSampleBits;

/// TACHYLITE_NET_BITS: up to 2^that many points. All of them, 24, take 29 CPU seconds.
TEST(SamplerExtent, PrefixesAreNets) {
  const char* wanted = std::getenv("TACHYLITE_NET_BITS");
  const size_t count = size_t{1} << (wanted ? std::atoi(wanted) : 20);
  const uint pixel = pixel_key(2073599, 4294967295u), group = group_directions(kFirstHashedVertex - 1);
  expect_nets(draw(pixel, group, count, [](uint i) { return i; }), "the last group");
}

TEST(SamplerExtent, PrefixesOfOtherGroupsAreNets) {
  for (uint seed : {0u, 1u})
    for (uint group : {kGroupCamera, kGroupLens, group_choices(0), group_medium(5), group_extra(7)})
      expect_nets(draw(pixel_key(31 * seed + 7, seed), group, 1 << 14, [](uint i) { return i; }),
                  fmt::format("group {}", group));
}

/// The last 2^10, 2^11 ... of all 2^24 points are nets, too, and none is among the first.
TEST(SamplerExtent, TheLastPointsAreNets) {
  constexpr size_t kCount = 1 << 16;
  const uint pixel = pixel_key(5, 6);
  const std::vector<uvec4> first = draw(pixel, kGroupCamera, kCount, [](uint i) { return i; });
  const std::vector<uvec4> last = draw(pixel, kGroupCamera, kCount, [](uint i) { return kPoints - 1 - i; });
  expect_nets(last, "the last points");
  // In each dimension, each of the 2^24 has its own interval.
  for (int d = 0; d < 4; ++d) {
    std::vector<bool> taken(kPoints);
    size_t again = 0;
    for (const auto* points : {&first, &last})
      for (const uvec4& point : *points) {
        const uint interval = point[d] >> (32 - kMaxSampleBits);
        again += taken[interval];
        taken[interval] = true;
      }
    EXPECT_EQ(again, 0u) << d;
  }
}

/// The numbers of a pixel, a seed, an index and a group.
struct Key {
  uint pixel = 0, seed = 0, index = 0, group = 0;
};

/// Dimension a of one key against dimension b of another, over 2^16 pixels, in 16 x 16 bins: uniform where they are
/// independent. P(chi2 > 403) = 1e-8 a test at 255 degrees of freedom, 5e-6 for all; a density with a relative standard
/// deviation of 0.06 between bins is seen with a power of 0.99.
void expect_independent(uint kind, const std::string& name, const std::function<std::array<Key, 2>(uint)>& keys) {
  constexpr uint kPixels = 1 << 16, kBins = 16;
  std::vector<std::array<uvec4, 2>> draws(kPixels);
  for (uint pixel = 0; pixel < kPixels; ++pixel) {
    const std::array<Key, 2> pair = keys(pixel);
    for (size_t i = 0; i < 2; ++i)
      draws[pixel][i] =
          sample_group(kind, pixel_key(pair[i].pixel, pair[i].seed), pair[i].index, pair[i].group, kMaxSampleBits);
  }
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) {
      std::vector<double> counts(kBins * kBins);
      for (const auto& [x, y] : draws) ++counts[(x[a] >> 28) * kBins + (y[b] >> 28)];
      constexpr double kExpected = double{kPixels} / (kBins * kBins);
      double chi2 = 0;
      for (const double count : counts) chi2 += (count - kExpected) * (count - kExpected) / kExpected;
      EXPECT_LT(chi2, 403) << name << ", kind " << kind << ", dimensions " << a << b;
    }
}

TEST(SamplerExtent, PairsAreIndependent) {
  constexpr uint kWidth = 1920, kLast = (1u << kMaxSampleBits) - 1;
  for (const uint kind : {kSamplerSobol, kSamplerIndependent}) {
    for (const uint index : {0u, kLast}) {
      const uint group = group_directions(2);
      const auto expect = [&](const char* name, const Key& step, uint other_group) {
        expect_independent(kind, name, [=](uint pixel) -> std::array<Key, 2> {
          return {{{pixel, 7, index, group}, {pixel + step.pixel, 7 + step.seed, index, other_group}}};
        });
      };
      expect("the next pixel", {.pixel = 1}, group);
      expect("the pixel below", {.pixel = kWidth}, group);
      expect("the next seed", {.seed = 1}, group);
      expect("the next seed of the next pixel", {.pixel = 1, .seed = 1}, group);
      expect("the last seed of the next pixel", {.pixel = 1, .seed = 0u - 1}, group);
      expect("another seed", {.seed = 0x10000}, group);
      expect("choices", {}, group_choices(2));
      expect("the next vertex", {}, group_directions(3));
      expect("the camera", {}, kGroupCamera);
    }
  }
  // Samples of one pixel are independent of each other only where they are meant to be.
  expect_independent(kSamplerIndependent, "the next sample", [](uint pixel) -> std::array<Key, 2> {
    return {{{pixel, 7, 5, kGroupCamera}, {pixel, 7, 6, kGroupCamera}}};
  });
  expect_independent(kSamplerIndependent, "samples of one pixel", [](uint index) -> std::array<Key, 2> {
    return {{{3, 7, 2 * index, kGroupCamera}, {3, 7, 2 * index + 1, kGroupCamera}}};
  });
}

}  // namespace
}  // namespace tachylite::gpu
