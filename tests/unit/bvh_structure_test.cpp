#include <cstring>
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "accel/bvh.h"
#include "base/error.h"
#include "base/parallel.h"
#include "support/bvh_scenes.h"
#include "support/bvh_traversal.h"

namespace tachylite::test {
namespace {

bool has_area(const TestScene& s, const glm::uvec3& t) {
  const glm::dvec3 a(s.vertices[t.x]), b(s.vertices[t.y]), c(s.vertices[t.z]);
  return glm::cross(b - a, c - a) != glm::dvec3(0);
}

/// Points of the surface of a curved primitive.
glm::dvec3 curved_point(const CurvedPrimitive& c, RandomPlaces& random) {
  glm::dvec3 p = random.direction();
  const double r = std::hypot(p.x, p.y);
  if (c.kind == gpu::kLeafDisk) p.z = 0;
  if (c.kind == gpu::kLeafCylinder) p = {p.x / r, p.y / r, random.uniform()};
  return glm::dvec3(c.object_to_world * glm::dvec4(p, 1));
}

/// Walks the whole structure and checks what shared/bvh.h promises.
class Walker {
 public:
  Walker(const TestScene& scene, const Bvh8& bvh) : scene_(scene), bvh_(bvh) {}

  void check() {
    ASSERT_EQ(bvh_.nodes.size() % gpu::kBvhNodeRows, 0u);
    walk(0, {}, 1);
    EXPECT_EQ(leaves_.size(), bvh_.first_wall);
    for (uint32_t leaf = bvh_.first_wall; leaf < bvh_.leaves.size(); ++leaf)
      check_leaf(leaf, gpu::kLeafTriangles, {});
    const BvhStatistics& stats = bvh_.statistics;
    EXPECT_EQ(nodes_.size(), stats.nodes8);
    EXPECT_EQ(leaves_.size(), bvh_.leaves.size());
    EXPECT_EQ(leaves_.size(), stats.leaves);
    EXPECT_EQ(depth_, stats.depth8);
    EXPECT_LE(depth_, static_cast<int>(gpu::kBvhMaxDepth));
    EXPECT_EQ(stats.node_bytes, bvh_.nodes.size() * 16);
    uint64_t expected = scene_.curved.size();
    for (size_t i = 0; i < scene_.triangles.size(); ++i) {
      const bool kept = has_area(scene_, scene_.triangles[i]);
      expected += kept;
      EXPECT_EQ(primitives_.count(static_cast<uint32_t>(i)), kept) << "triangle " << i;
    }
    EXPECT_EQ(primitives_.size(), expected);
    for (const auto& [primitive, times] : primitives_) EXPECT_EQ(times, 1) << "primitive " << primitive;
    EXPECT_EQ(stats.dropped + expected, scene_.triangles.size() + scene_.curved.size());
    EXPECT_EQ(stats.leaves + stats.pairs, expected);
  }

 private:
  struct Bounds {
    glm::vec3 lo{-std::numeric_limits<float>::infinity()}, hi{std::numeric_limits<float>::infinity()};
  };

  void walk(uint32_t node, const Bounds& outer, int depth) {
    ASSERT_TRUE(nodes_.insert({node, 1}).second) << "node " << node << " has two parents";
    depth_ = std::max(depth_, depth);
    const DecodedNode n = decode_node(bvh_, node);
    EXPECT_EQ(n.inner_mask & n.leaf_mask, 0u);
    for (uint32_t s = 0; s < 8; ++s) {
      if (!((n.inner_mask | n.leaf_mask) >> s & 1)) {
        check_empty_slot(node, s);
        EXPECT_EQ(leaf_kind(n, s), 0u);
        continue;
      }
      // A child's box may stick out of its parent's by the parent's own rounding, so what counts is the meet.
      const Bounds b{glm::max(outer.lo, n.lo[s]), glm::min(outer.hi, n.hi[s])};
      if (n.inner_mask >> s & 1)
        walk(n.child_base * 8 + s, b, depth + 1);
      else
        check_leaf(leaf_of_slot(n, s), leaf_kind(n, s), b);
    }
  }

  void check_empty_slot(uint32_t node, uint32_t slot) {
    const glm::uvec4* row = &bvh_.nodes[size_t{node} * gpu::kBvhNodeRows];
    const uint32_t words[12] = {row[2].x, row[2].y, row[2].z, row[2].w, row[3].x, row[3].y,
                                row[3].z, row[3].w, row[4].x, row[4].y, row[4].z, row[4].w};
    for (uint32_t a = 0; a < 6; ++a)
      EXPECT_EQ(words[2 * a + slot / 4] >> 8 * (slot % 4) & 0xff, a < 3 ? 255u : 0u) << "node " << node;
  }

  void inside(const glm::dvec3& p, const Bounds& b) {
    for (int a = 0; a < 3; ++a) {
      EXPECT_GE(p[a], b.lo[a]);
      EXPECT_LE(p[a], b.hi[a]);
      EXPECT_GE(p[a], bvh_.box_min[a]);
      EXPECT_LE(p[a], bvh_.box_max[a]);
    }
  }

  void check_leaf(uint32_t leaf, uint32_t kind, const Bounds& b) {
    ASSERT_LT(leaf, bvh_.leaves.size());
    EXPECT_TRUE(leaves_.insert({leaf, 1}).second);
    const glm::uvec4 info = bvh_.leaves[leaf].info;
    ++primitives_[info.x];
    EXPECT_EQ(kind, info.z);
    if (kind != gpu::kLeafTriangles) {
      const CurvedPrimitive& c = scene_.curved.at(info.x - scene_.triangles.size());
      EXPECT_EQ(info.z, c.kind);
      EXPECT_EQ(info.y, info.x);
      for (int k = 0; k < 200; ++k) inside(curved_point(c, random_), b);
      const glm::dmat4 inverse = glm::inverse(c.object_to_world);
      for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 4; ++k)
          EXPECT_FLOAT_EQ(bvh_.leaves[leaf].rows[r][k],
                          static_cast<float>(inverse[k][r]));
      return;
    }
    const auto v = leaf_vertices(bvh_, leaf);
    for (const glm::vec3& p : v) inside(p, b);
    check_triangle({v[0], v[1], v[2]}, info.x, info.w & 3);
    if (info.y == info.x) {
      EXPECT_EQ(v[2], v[3]);
    } else {
      ++primitives_[info.y];
      check_triangle({v[0], v[2], v[3]}, info.y, info.w >> 2);
    }
  }

  void check_triangle(const std::array<glm::vec3, 3>& v, uint32_t primitive, uint32_t rotation) {
    ASSERT_LT(rotation, 3u);
    for (uint32_t k = 0; k < 3; ++k) {
      const glm::vec3& mesh =
          scene_.vertices[scene_.triangles[primitive][static_cast<int>((k + rotation) % 3)]];
      EXPECT_EQ(std::memcmp(&v[k], &mesh, sizeof mesh), 0);
    }
  }

  const TestScene& scene_;
  const Bvh8& bvh_;
  RandomPlaces random_{99};
  std::map<uint32_t, int> nodes_, leaves_, primitives_;
  int depth_ = 0;
};

void expect_valid(const TestScene& scene, const BvhSettings& settings = {}) {
  const Bvh8 bvh = build_bvh8(scene.input(), settings);
  Walker(scene, bvh).check();
}

TEST(BvhStructure, TriangleSoup) {
  expect_valid(triangle_soup(20000, .05, 1));
}
TEST(BvhStructure, Mesh) {
  expect_valid(bumpy_sphere(60, 120, .05, 2));
}
TEST(BvhStructure, Slivers) {
  expect_valid(slivers(3000, 3));
}
TEST(BvhStructure, CoplanarDuplicates) {
  expect_valid(coplanar_duplicates(2000, 4));
}
TEST(BvhStructure, HugeNextToTiny) {
  expect_valid(huge_and_tiny(5000, 5));
}
TEST(BvhStructure, FewPrimitives) {
  for (int n = 1; n <= 20; ++n) expect_valid(triangle_soup(n, .3, static_cast<uint32_t>(n)));
}
TEST(BvhStructure, Curved) {
  TestScene s = triangle_soup(300, .1, 6);
  add_curved(s, 300, 7);
  expect_valid(s);
}

TEST(BvhStructure, Walls) {
  BvhSettings settings;
  settings.most_walls = 8;
  expect_valid(furnished_room(), settings);
}

TEST(BvhStructure, EmptyInput) {
  const TestScene s;
  expect_valid(s);
  const Bvh8 bvh = build_bvh8(s.input());
  EXPECT_GE(bvh.nodes.size(), gpu::kBvhNodeRows);
  EXPECT_TRUE(bvh.leaves.empty());
}

TEST(BvhStructure, DegenerateTrianglesAreDropped) {
  TestScene s = triangle_soup(50, .3, 8);
  s.add({1, 2, 3}, {1, 2, 3}, {1, 2, 3});
  s.add({0, 0, 0}, {1, 0, 0}, {2, 0, 0});
  s.triangles.emplace_back(0, 0, 1);
  expect_valid(s);
  EXPECT_EQ(build_bvh8(s.input()).statistics.dropped, 3u);
}

TEST(BvhStructure, AllDegenerate) {
  TestScene s;
  for (int i = 0; i < 100; ++i) s.add(glm::vec3(i), glm::vec3(i), glm::vec3(i));
  expect_valid(s);
  EXPECT_EQ(build_bvh8(s.input()).statistics.dropped, 100u);
}

TEST(BvhStructure, CoincidentTriangles) {
  TestScene s;
  for (int i = 0; i < 3000; ++i) s.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  expect_valid(s);
}

/// Sizes in geometric progression put one leaf on each level of a tree built by area alone.
TEST(BvhStructure, DepthIsBounded) {
  TestScene s;
  for (int i = 0; i < 2000; ++i) {
    const auto r = static_cast<float>(1e15 * std::pow(.96, i));
    s.add({r, 0, 0}, {r, .01f * r, 0}, {1.01f * r, 0, .01f * r});
  }
  expect_valid(s);
}

TEST(BvhStructure, ExtremeCoordinates) {
  for (float scale : {1e-30f, 1e-20f, 1e-4f, 1e6f, 9e17f}) {
    TestScene s = triangle_soup(500, .1, 9);
    for (glm::vec3& v : s.vertices) v *= scale / 1.2f;
    expect_valid(s);
  }
}

TEST(BvhStructure, BadNumbersAreRefused) {
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e18f}) {
    TestScene s = triangle_soup(10, .1, 10);
    s.vertices[17].y = bad;
    EXPECT_THROW(build_bvh8(s.input()), InputError);
  }
  TestScene s;
  s.curved.push_back({gpu::kLeafSphere, glm::dmat4(0)});
  EXPECT_THROW(build_bvh8(s.input()), InputError);
  s.curved[0].object_to_world = glm::dmat4(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(build_bvh8(s.input()), InputError);
}

TEST(BvhStructure, ReinsertionLowersTheCost) {
  for (const TestScene& s :
       {triangle_soup(20000, .05, 14), bumpy_sphere(60, 120, .05, 15), huge_and_tiny(5000, 16)}) {
    BvhSettings settings;
    settings.reinsertion_passes = 0;
    expect_valid(s, settings);
    const BvhStatistics before = build_bvh8(s.input(), settings).statistics;
    settings.reinsertion_passes = 12;
    expect_valid(s, settings);
    const BvhStatistics after = build_bvh8(s.input(), settings).statistics;
    EXPECT_LT(after.sah_cost2, before.sah_cost2);
    EXPECT_LT(after.sah_cost8, before.sah_cost8);
    EXPECT_GT(after.sah_cost8, 1);
    EXPECT_LT(after.sah_cost8, after.sah_cost2);
  }
}

template <class T>
void expect_same_bytes(const BulkVector<T>& a, const BulkVector<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(T)), 0);
}

TEST(BvhStructure, SameBytesForAnyNumberOfThreads) {
  TestScene s = bumpy_sphere(150, 300, .05, 11);
  for (const TestScene& more : {triangle_soup(20000, .02, 12), coplanar_duplicates(3000, 13)})
    for (const glm::uvec3& t : more.triangles)
      s.add(more.vertices[t.x], more.vertices[t.y], more.vertices[t.z]);
  set_thread_count(1);
  const Bvh8 one = build_bvh8(s.input());
  for (int threads : {2, 2, 3}) {
    set_thread_count(threads);
    const Bvh8 many = build_bvh8(s.input());
    expect_same_bytes(one.nodes, many.nodes);
    expect_same_bytes(one.leaves, many.leaves);
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace tachylite::test
