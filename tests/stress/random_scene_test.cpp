// A few of the random scenes of the long run (tachylite_stress), on the device against the reference. What each sees
// is in judge_scene.h: false alarms are 1e-7 a scene; the first pair of images, 512 samples of some 300 pixels, shows
// biases of the mean of typically 3 to 10 %.

#include <functional>

#include <gtest/gtest.h>

#include "stress/judge_scene.h"
#include "stress/minimise_scene.h"
#include "stress/random_scene.h"
#include "support/device_test.h"

namespace tachylite::test {
namespace {

class RandomScene : public DeviceTest, public ::testing::WithParamInterface<uint64_t> {};

TEST_P(RandomScene, DeviceAndReference) {
  JudgeOptions options;
  options.seed = static_cast<uint32_t>(GetParam());
  const Judgement judgement = judge_scene(device(), random_scene(GetParam()), options);
  EXPECT_EQ(judgement.verdict, Judgement::Verdict::kAgree) << judgement.message;
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomScene, ::testing::Values(5, 1000005, 2000003, 3000001, kFirstWideSeed + 7));

// The generator is the same on every machine, or seeds would mean nothing.
TEST(RandomSceneText, FollowsFromItsSeed) {
  const SceneText a = random_scene(77), b = random_scene(77), c = random_scene(78);
  EXPECT_EQ(a.xml(), b.xml());
  EXPECT_EQ(a.files, b.files);
  EXPECT_NE(a.xml(), c.xml());
}

// What the latest generator is there for does occur.
TEST(RandomSceneText, HasWhatIsNested) {
  int maps = 0, boards = 0, sides = 0;
  // Counts elements of one type that lie in one of another, at any depth.
  const std::function<int(const Element&, std::string_view, std::string_view, bool)> count =
      [&](const Element& element, std::string_view outer, std::string_view inner, bool inside) {
        const std::string* type = element.attribute("type");
        int found = inside && type && type->ends_with(inner);
        inside |= type && type->ends_with(outer);
        for (const Element& child : element.children) found += count(child, outer, inner, inside);
        return found;
      };
  for (uint64_t seed = kFirstNestedSeed; seed < kFirstNestedSeed + 10 * kScenesOfTheme; ++seed)
    for (const Element& element : random_scene(seed).elements) {
      maps += count(element, "map", "map", false) - count(element, "map", "bitmap", false);
      sides += count(element, "map", "twosided", false);
      boards += count(element, "checkerboard", "bitmap", false) + count(element, "checkerboard", "board", false);
    }
  EXPECT_GT(maps, 2);
  EXPECT_GT(sides, 2);
  EXPECT_GT(boards, 2);
}

TEST(MinimiseScene, KeepsWhatFails) {
  const SceneText least = minimise_scene(random_scene(18), [](const SceneText& scene) {
    return scene.xml().find("roughdielectric") != std::string::npos;
  });
  ASSERT_EQ(least.elements.size(), 1u);
  EXPECT_EQ(least.xml(), "  <shape type=\"sphere\">\n    <bsdf type=\"roughdielectric\"/>\n  </shape>\n");
  EXPECT_TRUE(least.files.empty());
}

}  // namespace
}  // namespace tachylite::test
