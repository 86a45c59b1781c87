#include <gtest/gtest.h>

#include "accel/bvh.h"
#include "support/bvh_scenes.h"
#include "support/bvh_traversal.h"

namespace tachylite::test {
namespace {

/// A point of a random primitive.
glm::dvec3 surface_point(const BvhInput& input, RandomPlaces& random) {
  const size_t triangles = input.triangles.size();
  const auto i = static_cast<size_t>(random.uniform(0, static_cast<double>(triangles + input.curved.size())));
  if (i >= triangles) return glm::dvec3(input.curved[i - triangles].object_to_world[3]);
  const glm::uvec3 v = input.triangles[i];
  const double a = random.uniform(), b = random.uniform(0, 1 - a);
  return (1 - a - b) * glm::dvec3(input.vertices[v.x]) + a * glm::dvec3(input.vertices[v.y]) +
         b * glm::dvec3(input.vertices[v.z]);
}

/// Rays from inside and outside the scene, half of them towards primitives, the others towards points of the
/// scene's box; some along the axes.
std::vector<Ray> make_rays(const BvhInput& input, const Bvh8& bvh, int count, uint32_t seed) {
  RandomPlaces random(seed);
  const glm::dvec3 centre = 0.5 * (glm::dvec3(bvh.box_min) + glm::dvec3(bvh.box_max));
  const glm::dvec3 half = 0.5 * (glm::dvec3(bvh.box_max) - glm::dvec3(bvh.box_min));
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    Ray r;
    r.o = centre + half * random.in_cube(i % 3 ? 1 : 3);
    r.d = (i % 2 ? centre + half * random.in_cube(1) : surface_point(input, random)) - r.o;
    r.d = glm::normalize(r.d + 1e-30);
    if (i % 10 == 9) {
      r.d = glm::dvec3(0);
      r.d[i / 10 % 3] = i & 1 ? -1 : 1;
    }
    rays.push_back(r);
  }
  return rays;
}

/// The first hit must be the one of the exhaustive search, with the same barycentrics of the mesh's triangle.
/// Where several primitives tie (duplicates, shared edges) only t is compared. `least_hits`: the test must
/// test.
void expect_same_hits(const TestScene& scene, int ray_count, int least_hits) {
  const BvhInput input = scene.input();
  const Bvh8 bvh = build_bvh8(input);
  TraversalCounts counts;
  int hits = 0, ties = 0;
  for (const Ray& ray : make_rays(input, bvh, ray_count, 7)) {
    const TestHit expected = brute_force(input, ray), got = traverse(input, bvh, ray, counts);
    ASSERT_EQ(got.found(), expected.found()) << "primitives " << got.primitive << " " << expected.primitive;
    if (!got.found()) continue;
    ++hits;
    ASSERT_NEAR(got.t, expected.t, 1e-9 * expected.t);
    if (got.primitive != expected.primitive) {
      ++ties;
      continue;
    }
    ASSERT_NEAR(got.b1, expected.b1, 1e-6);
    ASSERT_NEAR(got.b2, expected.b2, 1e-6);
  }
  EXPECT_GE(hits, least_hits);
  testing::Test::RecordProperty("hits", hits);
  testing::Test::RecordProperty("ties", ties);
}

TEST(BvhTraversal, TriangleSoup) {
  expect_same_hits(triangle_soup(2000, .1, 1), 3000, 1500);
}
TEST(BvhTraversal, LargeTriangles) {
  expect_same_hits(triangle_soup(500, 1, 2), 2000, 1500);
}
TEST(BvhTraversal, Mesh) {
  expect_same_hits(bumpy_sphere(24, 48, .1, 3), 3000, 1500);
}
TEST(BvhTraversal, Slivers) {
  expect_same_hits(slivers(3000, 4), 3000, 1000);
}
TEST(BvhTraversal, CoplanarDuplicates) {
  expect_same_hits(coplanar_duplicates(300, 5), 3000, 500);
}
TEST(BvhTraversal, HugeNextToTiny) {
  expect_same_hits(huge_and_tiny(1500, 6), 2000, 500);
}
TEST(BvhTraversal, OneTriangle) {
  expect_same_hits(triangle_soup(1, 1, 8), 500, 20);
}
TEST(BvhTraversal, TwoTriangles) {
  expect_same_hits(triangle_soup(2, 1, 9), 500, 20);
}

TEST(BvhTraversal, CurvedPrimitives) {
  TestScene s;
  add_curved(s, 200, 10);
  expect_same_hits(s, 3000, 300);
}

TEST(BvhTraversal, CurvedAmongTriangles) {
  TestScene s = triangle_soup(500, .1, 11);
  add_curved(s, 100, 12);
  expect_same_hits(s, 3000, 1000);
}

TEST(BvhTraversal, FarFromTheOrigin) {
  TestScene s = bumpy_sphere(16, 32, .1, 13);
  for (glm::vec3& v : s.vertices) v = v * .1f + glm::vec3(1000, -2000, 500);
  expect_same_hits(s, 2000, 700);
}

TEST(BvhTraversal, NearChildrenComeFirst) {
  for (const TestScene& s : {triangle_soup(5000, .1, 14), bumpy_sphere(40, 80, .1, 15)}) {
    const Bvh8 bvh = build_bvh8(s.input());
    TraversalCounts near_first, far_first;
    for (const Ray& ray : make_rays(s.input(), bvh, 3000, 16)) {
      const TestHit a = traverse(s.input(), bvh, ray, near_first);
      const TestHit b = traverse(s.input(), bvh, ray, far_first, true);
      ASSERT_EQ(a.t, b.t);
    }
    EXPECT_LT(static_cast<double>(near_first.nodes), 0.8 * static_cast<double>(far_first.nodes));
    EXPECT_LE(near_first.stack, gpu::kBvhMaxDepth);
  }
}

TEST(BvhTraversal, EmptyInputHitsNothing) {
  const TestScene s;
  const Bvh8 bvh = build_bvh8(s.input());
  TraversalCounts counts;
  EXPECT_FALSE(traverse(s.input(), bvh, {{0, 0, 0}, {0, 0, 1}}, counts).found());
  EXPECT_EQ(counts.nodes, 1u);
}

}  // namespace
}  // namespace tachylite::test
