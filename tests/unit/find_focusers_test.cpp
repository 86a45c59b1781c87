// The spheres that guiding aims at: around what may throw light together, and only that.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pack/pack_scene.h"
#include "support/render_test.h"

namespace tachylite::test {
namespace {

std::string ball(double x, double radius, const std::string& bsdf) {
  return fmt::format(R"(<shape type="sphere"><point name="center" x="{}" y="0" z="0"/><float name="radius" value="{}"/>
<bsdf type="{}"/></shape>)", x, radius, bsdf);
}

// Positions are those of the world: all scenes have the box [-10, 10]^3.
std::vector<glm::vec4> focusers_of(const std::string& shapes) {
  const std::string room = R"(<shape type="cube"><transform name="to_world"><scale value="10"/></transform></shape>)";
  const PackedScene packed = pack_scene(
      scene_from_elements(R"(<integrator type="path"/>)" + sensor_element(8, 8) + room + shapes));
  return {packed.params.focusers, packed.params.focusers + packed.features.focusers};
}

TEST(FindFocusers, AreGlassAndMetal) {
  EXPECT_TRUE(focusers_of(ball(0, 1, "diffuse") + ball(3, 1, "plastic")).empty());
  for (const char* bsdf : {"dielectric", "roughdielectric", "conductor", "roughconductor"}) {
    const std::vector<glm::vec4> one = focusers_of(ball(3, 0.5, bsdf) + ball(-3, 1, "diffuse"));
    ASSERT_EQ(one.size(), 1u) << bsdf;
    EXPECT_NEAR(glm::length(glm::vec3(one[0]) - glm::vec3(3, 0, 0)), 0, 1e-5);
    EXPECT_GE(one[0].w, 0.5f);
    EXPECT_LE(one[0].w, 0.51f);
  }
}

TEST(FindFocusers, HoldMeshes) {
  const std::vector<glm::vec4> one = focusers_of(R"(<shape type="cube"><transform name="to_world">
<scale x="1" y="2" z="2"/><translate x="5"/></transform><bsdf type="dielectric"/></shape>)");
  ASSERT_EQ(one.size(), 1u);
  EXPECT_NEAR(one[0].x, 5, 1e-5);
  EXPECT_NEAR(one[0].w, 3, 0.01);
}

TEST(FindFocusers, ShareASphereWhereTheyAreNear) {
  std::string shapes;
  for (const double x : {-5.0, -4.8, 0.0, 5.0}) shapes += ball(x, 0.1, "dielectric");
  const std::vector<glm::vec4> three = focusers_of(shapes);
  ASSERT_EQ(three.size(), 3u);
  int common = 0;
  for (const glm::vec4& s : three)
    if (std::abs(s.x + 4.9) < 1e-4) {
      ++common;
      EXPECT_NEAR(s.w, 0.2, 0.001);
    }
  EXPECT_EQ(common, 1);
}

TEST(FindFocusers, LeaveOutWhatNearlyFillsTheScene) {
  EXPECT_TRUE(focusers_of(R"(<shape type="rectangle"><transform name="to_world"><scale value="9.9"/></transform>
<bsdf type="conductor"/></shape>)").empty());
}

}  // namespace
}  // namespace tachylite::test
