// A few of the random scenes of the long run (tachylite_stress), on the device against the reference. What each sees
// is in judge_scene.h: false alarms are 1e-7 a scene; the first pair of images, 512 samples of some 300 pixels, shows
// biases of the mean of typically 3 to 10 %.

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
