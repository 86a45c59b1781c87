// Paths guided by photons: the same image as without, with less noise where glass and metal throw light together.

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "pack/pack_scene.h"
#include "shared/guide.h"
#include "support/render_test.h"
#include "wavefront/photon_guide.h"

namespace tachylite::test {
namespace {

using Guided = DeviceTest;

constexpr const char* kLampEnd = R"(<emitter type="area"><rgb name="radiance" value="20, 14, 8"/></emitter></shape>)";

std::string wall(const std::string& transform) {
  return R"(<shape type="rectangle"><transform name="to_world">)" + transform + R"(</transform><bsdf type="diffuse">
<rgb name="reflectance" value="0.8, 0.7, 0.6"/></bsdf></shape>)";
}

// A box that is open towards the camera, a ball on its floor, and a lamp: a shape without its end.
std::string room(const std::string& lamp, const std::string& ball = R"(<bsdf type="dielectric"/>)") {
  return R"(<integrator type="path"><integer name="max_depth" value="8"/></integrator>)" +
         sensor_element(24, 24, "0, 0, 3.9") + wall(R"(<rotate x="1" angle="-90"/><translate y="-1"/>)") +
         wall(R"(<rotate x="1" angle="90"/><translate y="1"/>)") + wall(R"(<translate z="-1"/>)") +
         wall(R"(<rotate y="1" angle="-90"/><translate x="1"/>)") +
         wall(R"(<rotate y="1" angle="90"/><translate x="-1"/>)") +
         R"(<shape type="sphere"><float name="radius" value="0.4"/><point name="center" x="0.3" y="-0.59" z="0.3"/>)" +
         ball + "</shape>" + lamp + kLampEnd;
}

RenderOptions in_stages(Guiding guiding, uint64_t samples = 32) {
  RenderOptions options;
  options.samples = samples;
  options.structure = KernelStructure::kStages;
  options.guiding = guiding;
  return options;
}

bool runs(const DeviceRender& render, const std::string& stage) {
  return std::find(render.stages_run.begin(), render.stages_run.end(), stage) != render.stages_run.end();
}

// Mean relative variance of a pixel.
double noise(const FilmBuffer& film) {
  double sum = 0;
  const double floor = 0.1 * image_mean(film).value.y;
  for (size_t i = 0; i < film.pixels(); ++i)
    sum += film.variance_of_mean(i).y / (film.mean(i).y * film.mean(i).y + floor * floor);
  return sum / static_cast<double>(film.pixels());
}

struct Lamp {
  const char* name;
  const char* shape;
};
const Lamp kLamps[] = {
    {"Rectangle", R"(<shape type="rectangle"><transform name="to_world"><scale value="0.12"/><rotate x="1" angle="90"/>
<translate y="0.8"/></transform>)"},
    {"Cube", R"(<shape type="cube"><transform name="to_world"><scale value="0.08"/><translate y="0.8"/></transform>)"},
    {"Sphere", R"(<shape type="sphere"><float name="radius" value="0.12"/><point name="center" x="0" y="0.8" z="0"/>)"},
    {"Disk", R"(<shape type="disk"><transform name="to_world"><scale value="0.12"/><rotate x="1" angle="90"/>
<translate y="0.8"/></transform>)"},
    {"Cylinder", R"(<shape type="cylinder"><float name="radius" value="0.06"/>
<point name="p0" x="-0.2" y="0.8" z="0"/><point name="p1" x="0.2" y="0.8" z="0"/>)"}};
class GuidedLamps : public DeviceTest, public ::testing::WithParamInterface<Lamp> {};

// Photons that leave a lamp from the wrong places or in wrong directions find other caustics. Measured: about 0.4 to 0.6 of
// the noise; with photons that leave by the lamp's back, 0.81 to 0.96, or no caustics at all.
TEST_P(GuidedLamps, HaveLessNoise) {
  const Scene scene = scene_from_elements(room(GetParam().shape));
  const DeviceRender off = render_on_device(scene, in_stages(Guiding::kOff, 128));
  const DeviceRender on = render_on_device(scene, in_stages(Guiding::kAuto, 128));
  ASSERT_TRUE(runs(on, "shade_surface<diffuse> guided"));
  EXPECT_LT(noise(on.film), 0.7 * noise(off.film));
}
INSTANTIATE_TEST_SUITE_P(, GuidedLamps, ::testing::ValuesIn(kLamps), [](const auto& lamp) { return lamp.param.name; });

TEST_F(Guided, AgreesWithReference) {
  VerifyOptions options;
  options.mean_bias = 0.03;
  options.block_bias = 0.5;
  options.most_samples = 8192;
  const Scene scene = scene_from_elements(room(kLamps[2].shape));
  expect_agreement(scene, scene, options, in_stages(Guiding::kAuto));
}

// Half of the light from a lamp as large as the ceiling is found by directions, whose density must be the guided one.
TEST_F(Guided, AgreesWithReferenceUnderALargeLamp) {
  VerifyOptions options;
  options.block_bias = 0.2;
  const Scene scene = scene_from_elements(
      room(R"(<shape type="rectangle"><transform name="to_world"><scale value="0.95"/><rotate x="1" angle="90"/>
<translate y="0.95"/></transform>)"));
  expect_agreement(scene, scene, options, in_stages(Guiding::kOn));
}

TEST_F(Guided, ImageDoesNotDependOnPathsInFlight) {
  const Scene scene = scene_from_elements(room(kLamps[0].shape));
  RenderOptions options = in_stages(Guiding::kAuto, 16);
  const DeviceRender all = render_on_device(scene, options);
  options.max_paths = 4096;
  const DeviceRender few = render_on_device(scene, options);
  ASSERT_TRUE(runs(few, "shade_surface<diffuse> guided"));
  for (size_t i = 0; i < all.film.pixels(); ++i) ASSERT_EQ(all.film.mean(i), few.film.mean(i));
  // Other photons, other directions.
  options.guiding = Guiding::kOff;
  const DeviceRender off = render_on_device(scene, options);
  size_t same = 0;
  for (size_t i = 0; i < all.film.pixels(); ++i) same += all.film.mean(i) == off.film.mean(i);
  EXPECT_LT(same, all.film.pixels() / 10);
}

TEST(Guiding, OnlyWhereThereMayBeCaustics) {
  const auto may_be = [](const std::string& elements, Guiding guiding = Guiding::kAuto) {
    return may_be_guided(pack_scene(scene_from_elements(elements)), guiding);
  };
  const std::string lamp = kLamps[0].shape, diffuse = R"(<bsdf type="diffuse"/>)";
  EXPECT_TRUE(may_be(room(lamp)));
  EXPECT_TRUE(may_be(room(lamp, R"(<bsdf type="roughconductor"/>)")));
  EXPECT_FALSE(may_be(room(lamp), Guiding::kOff));
  EXPECT_FALSE(may_be(room(lamp, diffuse)));  // nothing focuses
  EXPECT_TRUE(may_be(room(lamp, diffuse), Guiding::kOn));
  // Light that photons do not tell; it would get too few paths.
  EXPECT_FALSE(may_be(room(lamp) + R"(<emitter type="constant"/>)", Guiding::kOn));
  EXPECT_FALSE(may_be(room(lamp) + R"(<emitter type="point"/>)", Guiding::kOn));
}

TEST(Guiding, PaysFromTheShareOfCausticsOn) {
  const std::vector<uint32_t> flux(256, 1000 * static_cast<uint32_t>(gpu::kPhotonUnit));
  const double caustics = kCausticShare * 256000 * gpu::kCausticUnit;
  EXPECT_TRUE(guide_pays(flux, static_cast<uint32_t>(1.01 * caustics)));
  EXPECT_FALSE(guide_pays(flux, static_cast<uint32_t>(0.99 * caustics)));
  EXPECT_FALSE(guide_pays(std::vector<uint32_t>(256), 0));
}

}  // namespace
}  // namespace tachylite::test
