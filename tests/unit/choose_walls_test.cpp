// Which parallelograms a tree leaves out: those that many rays meet, and nothing else.

#include <algorithm>

#include <gtest/gtest.h>

#include "accel/bvh.h"
#include "support/bvh_scenes.h"

namespace tachylite::test {
namespace {

/// First triangles of the walls, in ascending order.
std::vector<uint32_t> walls_of(const TestScene& scene, uint32_t most) {
  BvhSettings settings;
  settings.most_walls = most;
  const Bvh8 bvh = build_bvh8(scene.input(), settings);
  std::vector<uint32_t> walls;
  for (uint32_t leaf = bvh.first_wall; leaf < bvh.leaves.size(); ++leaf)
    walls.push_back(std::min(bvh.leaves[leaf].info.x, bvh.leaves[leaf].info.y));
  std::sort(walls.begin(), walls.end());
  EXPECT_EQ(bvh.statistics.walls, walls.size());
  return walls;
}

using Walls = std::vector<uint32_t>;

TEST(ChooseWalls, TakesTheRoomsAndLeavesItsFurniture) {
  const TestScene room = furnished_room();
  EXPECT_EQ(walls_of(room, 8), (Walls{0, 2, 4, 6, 8}));
  EXPECT_EQ(walls_of(room, 0), Walls{});
  EXPECT_EQ(walls_of(room, 2).size(), 2u);
}

TEST(ChooseWalls, LeavesWhatIsNoParallelogram) {
  TestScene scene = triangle_soup(100, .05, 18);
  const auto first = static_cast<uint32_t>(scene.triangles.size());
  scene.add({-1, -1, -1}, {1, -1, -1}, {1, -1, 1});  // alone
  scene.add({-1, 1, -1}, {1, 1, -1}, {1, 1, 1});     // a trapezium with the next
  scene.add({-1, 1, -1}, {1, 1, 1}, {0, 1, 1});
  EXPECT_EQ(walls_of(scene, 8), Walls{});
  add_parallelogram(scene, {-1, -1, -1}, {.3f, 2, 0}, {0, .2f, 2});  // sheared
  EXPECT_EQ(walls_of(scene, 8), (Walls{first + 3}));
}

// A ground a thousand times as large as the room on it does not hide the room's walls.
TEST(ChooseWalls, LooksAtWhatIsLeft) {
  TestScene scene = furnished_room();
  const auto ground = static_cast<uint32_t>(scene.triangles.size());
  add_parallelogram(scene, {-1000, -1.1f, -1000}, {2000, 0, 0}, {0, 0, 2000});
  EXPECT_EQ(walls_of(scene, 8), (Walls{0, 2, 4, 6, 8, ground}));
}

TEST(ChooseWalls, MayTakeAll) {
  TestScene scene;
  add_parallelogram(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(walls_of(scene, 8), (Walls{0}));
}

}  // namespace
}  // namespace tachylite::test
