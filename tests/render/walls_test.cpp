// Walls outside of the tree: the same hits as in the tree.

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pack/pack_scene.h"
#include "support/render_test.h"

namespace tachylite::test {
namespace {

using Walls = DeviceTest;

// A wall of [-1, 1]^2, put into place.
std::string wall(const std::string& transform) {
  return R"(<shape type="rectangle"><transform name="to_world">)" + transform + R"(</transform><bsdf type="twosided">
<bsdf type="diffuse"><texture name="reflectance" type="checkerboard"><transform name="to_uv"><scale value="3"/></transform>
</texture></bsdf></bsdf></shape>)";
}

// A room with a tree of some balls, open to the camera; turn: degrees about an axis that is none of the room's.
std::string room(double turn, const std::string& integrator, const std::string& more) {
  const std::string turned = fmt::format(R"(<rotate x="1" y="2" z="0.5" angle="{}"/>)", turn);
  std::string elements = integrator + sensor_element(32, 32, "0, 0, 3.9") +
                         wall(R"(<rotate x="1" angle="-90"/><translate y="-1"/>)" + turned) +
                         wall(R"(<rotate x="1" angle="90"/><translate y="1"/>)" + turned) +
                         wall(R"(<translate z="-1"/>)" + turned) +
                         wall(R"(<rotate y="1" angle="-90"/><translate x="1"/>)" + turned) +
                         wall(R"(<rotate y="1" angle="90"/><translate x="-1"/>)" + turned) + more;
  for (const double x : {-0.5, 0.0, 0.5})
    elements += fmt::format(R"(<shape type="sphere"><float name="radius" value="0.2"/>
<point name="center" x="{}" y="{}" z="0.1"/><bsdf type="plastic"/></shape>)", x, -0.3 * x);
  return elements;
}

RenderOptions in_stages(uint64_t samples) {
  RenderOptions options;
  options.samples = samples;
  options.structure = KernelStructure::kStages;
  return options;
}

std::string lamp_at(const std::string& place) {
  return R"(<shape type="sphere"><float name="radius" value="0.1"/><point name="center" )" + place +
         R"(/><emitter type="area"><rgb name="radiance" value="400"/></emitter></shape>)";
}

std::string path_of_five(bool hide_emitters) {
  return fmt::format(R"(<integrator type="path"><integer name="max_depth" value="5"/>
<boolean name="hide_emitters" value="{}"/></integrator>)", hide_emitters);
}

// hide_emitters keeps all in the tree; no lamp is in view. Rounding alone may change a path: a bias of a thousandth of a
// pixel's value would show in most pixels.
void expect_hits_of_tree(const std::string& elements) {
  const Scene walls = scene_from_elements(path_of_five(false) + elements);
  const Scene tree = scene_from_elements(path_of_five(true) + elements);
  ASSERT_TRUE(pack_scene(walls).features.walls);
  ASSERT_FALSE(pack_scene(tree).features.walls);
  const DeviceRender a = render_on_device(walls, in_stages(16)), b = render_on_device(tree, in_stages(16));
  size_t different = 0;
  for (size_t i = 0; i < a.film.pixels(); ++i)
    different += std::abs(a.film.mean(i).y - b.film.mean(i).y) > 1e-4 * (b.film.mean(i).y + 1e-3);
  EXPECT_LT(different, a.film.pixels() / 20);
  EXPECT_GT(image_mean(b.film).value.y, 0.01);
}

TEST_F(Walls, AreHitAsInTheTree) {
  for (const double turn : {0.0, 15.0}) {
    SCOPED_TRACE(turn);
    expect_hits_of_tree(room(turn, "", lamp_at(R"(x="0.5" y="0.5" z="4.5")")));
  }
}

// A floor through the origin of device space, whose corners may be off it by what is left of cos 90 (it depends on how
// the host was compiled): rays that leave the triangles start above the floor of the walls.
TEST_F(Walls, DoNotShadowThemselves) {
  const std::string point = R"(<emitter type="point"><point name="position" x="1" y="3" z="1"/>
<rgb name="intensity" value="10"/></emitter>)";
  for (const char* turn : {R"(<rotate x="1" angle="-90"/>)", R"(<rotate x="1" angle="-90.00001"/>)",
                           R"(<rotate x="1" y="0.1" z="0.2" angle="-70"/>)"})
    for (const double scale : {1.0, 30.0}) {
      SCOPED_TRACE(turn);
      expect_hits_of_tree(sensor_element(32, 32, "0, 3, 4") + point +
                          wall(fmt::format(R"(<scale value="{}"/>)", scale) + turn));
    }
}

// Shadow rays skip walls that have all of the scene on one side: not those that a lamp is behind.
TEST_F(Walls, KeepLightOut) {
  const std::string path = R"(<integrator type="path"><integer name="max_depth" value="2"/></integrator>)";
  const std::string cover = wall(R"(<scale value="3"/><translate z="5"/>)");  // behind the camera
  for (const char* place : {R"(x="0" y="1.4" z="0")", R"(x="-1.5" y="0" z="0")", R"(x="0" y="0" z="-1.3")"}) {
    const Scene scene = scene_from_elements(room(0, path, cover + lamp_at(place)));
    ASSERT_TRUE(pack_scene(scene).features.walls);
    const DeviceRender render = render_on_device(scene, in_stages(64));
    // Inside of the room, which the middle of the image sees.
    for (uint32_t y = 10; y < 22; ++y)
      for (uint32_t x = 10; x < 22; ++x) EXPECT_EQ(render.film.mean(y * 32 + x), glm::dvec3(0)) << place;
  }
}

TEST_F(Walls, AreOnlyWhereTheyPay) {
  const auto has_walls = [](const std::string& elements) {
    return pack_scene(scene_from_elements(elements)).features.walls;
  };
  const std::string path = R"(<integrator type="path"/>)", volpath = R"(<integrator type="volpath"/>)";
  const std::string lamp = lamp_at(R"(x="0" y="0.8" z="0")");
  EXPECT_TRUE(has_walls(room(0, path, lamp)));
  EXPECT_TRUE(has_walls(room(0, volpath, lamp)));  // nothing is passed through
  const std::string ball = R"(<shape type="sphere"><bsdf type="diffuse"/></shape>)";
  EXPECT_FALSE(has_walls(path + sensor_element(8, 8) + ball + lamp));
}

}  // namespace
}  // namespace tachylite::test
