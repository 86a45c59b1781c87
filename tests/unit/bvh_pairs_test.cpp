#include <gtest/gtest.h>

#include "accel/bvh.h"
#include "accel/pair_triangles.h"
#include "support/bvh_scenes.h"

namespace tachylite::test {
namespace {

/// n x n quads over the unit square, bent a little, two triangles each; with vertices of their own if
/// `split`.
TestScene grid(uint32_t n, bool split) {
  TestScene s;
  const auto point = [&](uint32_t i, uint32_t j) {
    const float x = static_cast<float>(i) / static_cast<float>(n),
                y = static_cast<float>(j) / static_cast<float>(n);
    return glm::vec3(x, y, .1f * x * y);
  };
  for (uint32_t j = 0; !split && j <= n; ++j)
    for (uint32_t i = 0; i <= n; ++i) s.vertices.push_back(point(i, j));
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      if (split) {
        s.add(point(i, j), point(i + 1, j), point(i + 1, j + 1));
        s.add(point(i, j), point(i + 1, j + 1), point(i, j + 1));
      } else {
        const uint32_t a = j * (n + 1) + i, b = a + n + 1;
        s.triangles.emplace_back(a, a + 1, b + 1);
        s.triangles.emplace_back(a, b + 1, b);
      }
    }
  return s;
}

TEST(BvhPairs, QuadsBecomePairs) {
  for (bool split : {false, true}) {
    const Pairing p = pair_triangles(grid(30, split).input(), 1);
    ASSERT_EQ(p.pairs.size(), 900u);
    for (const TrianglePair& pair : p.pairs) {
      EXPECT_EQ(pair.first % 2, 0u);
      EXPECT_EQ(pair.second, pair.first + 1);
    }
  }
}

TEST(BvhPairs, OnlyWithinAGroup) {
  TestScene s = grid(10, false);
  s.groups.resize(s.triangles.size());
  for (size_t i = 0; i < s.groups.size(); ++i) s.groups[i] = static_cast<uint32_t>(i % 2);
  for (const TrianglePair& pair : pair_triangles(s.input(), 1).pairs) {
    if (pair.second == TrianglePair::kNoTriangle) continue;
    EXPECT_EQ(s.groups[pair.first], s.groups[pair.second]);
  }
  for (size_t i = 0; i < s.groups.size(); ++i) s.groups[i] = static_cast<uint32_t>(i);
  EXPECT_EQ(pair_triangles(s.input(), 1).pairs.size(), s.triangles.size());
}

TEST(BvhPairs, OnlyOfEqualWinding) {
  TestScene s;
  s.add({0, 0, 0}, {1, 0, 0}, {1, 1, 0});
  s.add({0, 0, 0}, {0, 1, 0}, {1, 1, 0});
  EXPECT_EQ(pair_triangles(s.input(), 1).pairs.size(), 2u);
  std::swap(s.triangles[1].x, s.triangles[1].z);
  EXPECT_EQ(pair_triangles(s.input(), 1).pairs.size(), 1u);
}

/// The box of both is larger than the boxes of each: two leaves are cheaper to test.
TEST(BvhPairs, OnlyIfTheBoxIsSmall) {
  TestScene s;
  s.add({0, 0, 0}, {1, 1, 0}, {0, 1, 0});
  s.add({1, 1, 0}, {0, 0, 0}, {0, 1, 1});
  EXPECT_EQ(pair_triangles(s.input(), 1).pairs.size(), 1u);
  s.vertices[2] = {-10, 0, 0};
  s.vertices[5] = {0, 10, .1f};
  EXPECT_EQ(pair_triangles(s.input(), 1).pairs.size(), 2u);
  EXPECT_EQ(pair_triangles(s.input(), 10).pairs.size(), 1u);
}

/// Many triangles at one edge: each is in one pair at most, and the two directions meet.
TEST(BvhPairs, NonManifoldEdge) {
  TestScene s;
  s.vertices = {{0, 0, 0}, {0, 0, 1}};
  constexpr uint32_t kLeaves = 100;
  for (uint32_t i = 0; i < kLeaves; ++i) {
    s.vertices.emplace_back(cos(.06 * i), sin(.06 * i), .5);
    s.triangles.emplace_back(i % 2, 1 - i % 2, i + 2);
  }
  EXPECT_EQ(pair_triangles(s.input(), 10).pairs.size(), kLeaves / 2);
}

/// A strip whose triangles grow along it: each prefers the next, and only one pair at a time is the best of
/// both.
TEST(BvhPairs, GrowingStrip) {
  TestScene s;
  constexpr uint32_t kTriangles = 1000;
  double x = 0, size = 1e-6;
  for (uint32_t i = 0; i < kTriangles + 2; ++i, size *= 1.02) {
    s.vertices.emplace_back(x, i % 2 ? size : 0, 0);
    x += .5 * size;
  }
  for (uint32_t i = 0; i < kTriangles; ++i) s.triangles.emplace_back(i + i % 2, i + 1 - i % 2, i + 2);
  EXPECT_LE(pair_triangles(s.input(), 1.5).pairs.size(), kTriangles / 2 + 10);
}

TEST(BvhPairs, StatisticsAreDescribed) {
  TestScene s = grid(10, false);
  add_curved(s, 3, 1);
  s.triangles.emplace_back(0, 0, 1);
  const BvhStatistics stats = build_bvh8(s.input()).statistics;
  EXPECT_EQ(stats.triangles, 201u);
  EXPECT_EQ(stats.dropped, 1u);
  EXPECT_EQ(stats.pairs, 100u);
  EXPECT_EQ(stats.leaves, 103u);
  EXPECT_EQ(stats.nodes2, 102u);
  EXPECT_GE(stats.node_visits8, 1);
  const std::string text = describe(stats);
  EXPECT_NE(text.find("201 (1 degenerate"), std::string::npos) << text;
  EXPECT_NE(text.find("103 (100.0 % of triangles in 100 pairs, 3 curved)"), std::string::npos) << text;
}

}  // namespace
}  // namespace tachylite::test
