// Boxes among parallelograms: which faces are theirs, and which are not.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>

#include "pack/find_boxes.h"

namespace tachylite::test {
namespace {

using glm::dvec3;

/// The faces `present` (bits) of a sheared box, each from some corner and with its edges in some order.
void add_box(std::vector<Parallelogram>& all, const dvec3& corner, const std::array<dvec3, 3>& edges, unsigned present,
             std::mt19937& random) {
  for (size_t face = 0; face < 6; ++face) {
    if (!(present >> face & 1u)) continue;
    const size_t k = face / 2;
    dvec3 at = corner + (face % 2 ? edges[k] : dvec3(0));
    std::array<dvec3, 2> sides = {edges[(k + 1) % 3], edges[(k + 2) % 3]};
    for (dvec3& side : sides)
      if (random() % 2) {
        at += side;
        side = -side;
      }
    if (random() % 2) std::swap(sides[0], sides[1]);
    all.push_back({at, sides});
  }
  std::shuffle(all.begin(), all.end(), random);
}

const std::array<dvec3, 3> kEdges = {dvec3(2, 0.1, 0), dvec3(0, 1, 0.3), dvec3(0.2, 0, 3)};

TEST(FindBoxes, AllFaces) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Parallelogram> all;
    add_box(all, {1, 2, 3}, kEdges, 63, random);
    const std::vector<Box> boxes = find_boxes(all, 4, 1e-6);
    ASSERT_EQ(boxes.size(), 1u);
    EXPECT_EQ(boxes[0].face_count(), 6);
    for (size_t k = 0; k < 3; ++k)
      for (size_t side = 0; side < 2; ++side) {
        const Parallelogram& face = all[*boxes[0].faces[2 * k + side]];
        const dvec3& normal = boxes[0].normals[k];
        EXPECT_NEAR(glm::dot(normal, face.edges[0]), 0, 1e-12);
        EXPECT_NEAR(glm::dot(normal, face.edges[1]), 0, 1e-12);
        EXPECT_NEAR(glm::dot(normal, face.corner - boxes[0].centres[2 * k + side]), 0, 1e-12);
        const dvec3 across = boxes[0].centres[2 * k + 1] - boxes[0].centres[2 * k];
        EXPECT_GT(glm::dot(normal, across), 0);
      }
  }
}

TEST(FindBoxes, SomeFaces) {
  std::mt19937 random(2);
  for (unsigned present = 0; present < 64; ++present) {
    std::vector<Parallelogram> all;
    add_box(all, {-1, 0, 5}, kEdges, present, random);
    const std::vector<Box> boxes = find_boxes(all, 4, 1e-6);
    const bool enough = std::popcount(present) >= 4;
    ASSERT_EQ(boxes.size(), enough ? 1u : 0u) << present;
    if (enough) {
      EXPECT_EQ(boxes[0].face_count(), std::popcount(present)) << present;
    }
  }
}

TEST(FindBoxes, EachFaceBelongsToOneBox) {
  // Two boxes side by side, with both faces in between; a copy of one; and loose pieces that fit nowhere.
  std::mt19937 random(3);
  std::vector<Parallelogram> all;
  add_box(all, {0, 0, 0}, kEdges, 63, random);
  add_box(all, kEdges[0], kEdges, 63, random);
  add_box(all, kEdges[0], kEdges, 63, random);
  all.push_back({{0, 0, 0}, {kEdges[0], 0.999 * kEdges[1]}});
  all.push_back({{9, 0, 0}, {kEdges[0], kEdges[1]}});
  all.push_back({{0, 0, 0}, {kEdges[0], 2.0 * kEdges[0]}});  // degenerate
  const std::vector<Box> boxes = find_boxes(all, 4, 1e-6);
  ASSERT_EQ(boxes.size(), 3u);
  std::vector<int> uses(all.size(), 0);
  for (const Box& box : boxes) {
    EXPECT_EQ(box.face_count(), 6);
    for (const auto& face : box.faces) ++uses[*face];
  }
  EXPECT_EQ(std::count(uses.begin(), uses.end(), 1), 18);
  EXPECT_EQ(std::count(uses.begin(), uses.end(), 0), 3);
}

}  // namespace
}  // namespace tachylite::test
