// shared/sampler.h to its last index, 2^24 - 1: nets of all sizes up to 2^24 points, which do not repeat. And whether
// pixels, seeds, groups and dimensions know of each other in ways that a correlation (kernels/sampler_test.cpp) does
// not see: chi2 of pairs.

#include "shared/sampler.h"

#include <array>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace tachylite::gpu {
namespace {

constexpr uint kFirstNet = 10;

/// The boxes of area 2^(quality - size), 2^split of them along the first axis, that the first 2^size points of two
/// dimensions lie in: a net of that quality has 2^quality points in each.
class Boxes {
 public:
  Boxes(uint size, uint split, uint quality)
      : size_(size), split_(split), other_(size - quality - split), room_(1u << quality) {
    if (room_ == 1) taken_.resize(size_t{1} << size);
    else counts_.resize(size_t{1} << (size - quality));
  }

  uint size() const { return size_; }
  void add(uint x, uint y) {
    const uint column = split_ ? x >> (32 - split_) : 0, row = other_ ? y >> (32 - other_) : 0;
    const size_t box = (size_t{column} << other_) + row;
    if (room_ == 1) {
      too_many_ += taken_[box];
      taken_[box] = true;
    } else {
      too_many_ += ++counts_[box] > room_;
    }
  }
  /// Points in boxes that have enough without them. None, for all of a net.
  size_t too_many() const { return too_many_; }
  std::string name() const { return fmt::format("2^{} points, 2^{} x 2^{} boxes", size_, split_, other_); }

 private:
  uint size_, split_, other_, room_;
  size_t too_many_ = 0;
  std::vector<bool> taken_;
  std::vector<uint8_t> counts_;
};

/// Dimensions (0, 1) are a (0, 2)-sequence. Those with primitive polynomials of degrees 2 and 3 have t <= 1 + 2 (Sobol
/// 1967, "On the distribution of points in a cube and the approximate evaluation of integrals", theorem 3.3), and
/// t = 0 each.
void expect_nets(uint pixel, uint group, uint last) {
  constexpr uint kQuality23 = 3;
  std::vector<std::pair<Boxes, glm::uvec2>> all;
  for (uint size = last; size >= kFirstNet; size -= size > 16 ? 4 : 1) {  // the largest first
    all.push_back({{size, size / 2, 0}, {0, 1}});
    if (size < kMaxSampleBits)  // the memory of 2^24 boxes is far: a second each
      for (uint split : {0u, size / 3, size}) all.push_back({{size, split, 0}, {0, 1}});
    const uint coarse = size - kQuality23;
    for (uint split : {coarse / 3}) all.push_back({{size, split, kQuality23}, {2, 3}});
    for (uint dimension : {2u, 3u}) all.push_back({{size, size, 0}, {dimension, dimension}});
  }
  for (uint index = 0; index >> last == 0; ++index) {
    const uvec4 point = sample_group(kSamplerSobol, pixel, index, group, kMaxSampleBits);
    for (auto& [boxes, d] : all) {
      if (index >> boxes.size()) break;
      boxes.add(point[static_cast<int>(d.x)], point[static_cast<int>(d.y)]);
    }
  }
  for (const auto& [boxes, d] : all)
    EXPECT_EQ(boxes.too_many(), 0u) << boxes.name() << " of dimensions " << d.x << d.y << ", group " << group;
}

TEST(SamplerExtent, PrefixesAreNetsToTheLastIndex) {
  expect_nets(pixel_key(2073599, 4294967295u), group_directions(kFirstHashedVertex - 1), kMaxSampleBits);
}

TEST(SamplerExtent, PrefixesOfOtherGroupsAreNets) {
  for (uint seed : {0u, 1u})
    for (uint group : {kGroupCamera, kGroupLens, group_choices(0), group_medium(5), group_extra(7)})
      expect_nets(pixel_key(31 * seed + 7, seed), group, 16);
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
