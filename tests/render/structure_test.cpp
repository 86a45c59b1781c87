// One kernel for whole paths and the stages take the same samples through the same code: their images differ only
// where rounding sends a path another way.

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/render_test.h"

namespace tachylite::test {
namespace {

using Structure = DeviceTest;

FilmBuffer render(const Scene& scene, KernelStructure structure) {
  RenderOptions options;
  options.samples = 16;
  options.structure = structure;
  options.guiding = Guiding::kOff;  // the one kernel has none
  return render_on_device(scene, options).film;
}

// Of 24^2 pixels, each the mean of 16 paths, those that differ by more than 1e-4 relatively: a few for paths that
// graze an edge. A wrong weight, normal or sample dimension changes nearly all.
void expect_same_paths(const Scene& scene) {
  const FilmBuffer fused = render(scene, KernelStructure::kFused), stages = render(scene, KernelStructure::kStages);
  int different = 0;
  const int pixels = fused.width() * fused.height();
  for (int i = 0; i < pixels; ++i) {
    const glm::dvec3 a = fused.mean(static_cast<size_t>(i)), b = stages.mean(static_cast<size_t>(i));
    different += glm::length(a - b) > 1e-4 * (glm::length(b) + 1e-6);
  }
  EXPECT_LE(different, pixels / 50) << "of " << pixels;
}

TEST_F(Structure, CornellBox) { expect_same_paths(scene_from_elements(cornell_elements(24))); }

TEST_F(Structure, RussianRouletteAndUnlimitedDepth) {
  std::string elements = cornell_elements(24);
  const size_t end = elements.find("</integrator>");
  elements.replace(0, end, R"(<integrator type="path"><integer name="rr_depth" value="3"/>)");
  expect_same_paths(scene_from_elements(elements));
}

TEST_F(Structure, SpheresTrianglesAndPointLight) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  expect_same_paths(scene_from_elements(
      R"(<integrator type="path"><integer name="max_depth" value="6"/></integrator>)" +
          sensor_element(24, 24, "1, 2, 5") +
          R"(<shape type="sphere"><float name="radius" value="0.7"/><point name="center" x="-1" y="0" z="0"/></shape>
<shape type="obj"><string name="filename" value="t.obj"/><boolean name="face_normals" value="true"/></shape>
<shape type="rectangle"><transform name="to_world"><scale value="3"/><rotate x="1" angle="-90"/>
<translate y="-0.7"/></transform></shape>
<shape type="sphere"><float name="radius" value="0.2"/><point name="center" x="0" y="2" z="0"/>
<emitter type="area"><rgb name="radiance" value="9, 8, 7"/></emitter></shape>
<emitter type="point"><point name="position" x="2" y="2" z="2"/><rgb name="intensity" value="3, 3, 3"/></emitter>
<emitter type="constant"><rgb name="radiance" value="0.1, 0.2, 0.3"/></emitter>)",
      {{"t.obj", obj}}));
}

// Two balls, a plate and a lid of the given bsdfs in the Cornell box.
std::string with_materials(const std::array<std::string, 4>& bsdfs) {
  return cornell_elements(24) + R"(
<shape type="sphere"><float name="radius" value="0.3"/><point name="center" x="0.45" y="-0.65" z="0.4"/>)" + bsdfs[0] +
         R"(</shape><shape type="sphere"><float name="radius" value="0.3"/><point name="center" x="-0.4" y="-0.6" z="0.2"/>)" +
         bsdfs[1] + R"(</shape><shape type="rectangle"><transform name="to_world"><scale value="0.3"/>
<rotate x="1" y="1" angle="-40"/><translate x="0" y="0.2" z="0.1"/></transform>)" + bsdfs[2] +
         R"(</shape><shape type="cube"><transform name="to_world"><scale value="0.15"/><rotate y="1" angle="20"/>
<translate x="0.1" y="-0.8" z="0.75"/></transform>)" + bsdfs[3] + "</shape>";
}

TEST_F(Structure, SmoothMaterials) {
  expect_same_paths(scene_from_elements(with_materials(
      {R"(<bsdf type="dielectric"/>)", R"(<bsdf type="conductor"><string name="material" value="Au"/></bsdf>)",
       R"(<bsdf type="thindielectric"/>)", R"(<bsdf type="diffuse"/>)"})));
}

TEST_F(Structure, RoughMaterials) {
  expect_same_paths(scene_from_elements(with_materials(
      {R"(<bsdf type="roughdielectric"><string name="distribution" value="ggx"/><float name="alpha" value="0.2"/></bsdf>)",
       R"(<bsdf type="roughconductor"><string name="distribution" value="ggx"/><float name="alpha" value="0.3"/></bsdf>)",
       R"(<bsdf type="dielectric"/>)", R"(<bsdf type="conductor"/>)"})));
  expect_same_paths(scene_from_elements(with_materials(
      {R"(<bsdf type="roughplastic"><float name="alpha" value="0.2"/></bsdf>)", R"(<bsdf type="plastic"/>)",
       R"(<bsdf type="diffuse"/>)", R"(<bsdf type="dielectric"/>)"})));
}

// Some materials have two sides, some one, some two different ones: a class of all must ask the leaf.
TEST_F(Structure, SidesAndMasks) {
  const std::string diffuse = R"(<bsdf type="diffuse"><rgb name="reflectance" value="0.8, 0.2, 0.1"/></bsdf>)";
  const std::string metal = R"(<bsdf type="conductor"><string name="material" value="Cu"/></bsdf>)";
  expect_same_paths(scene_from_elements(with_materials(
      {diffuse, R"(<bsdf type="twosided">)" + metal + "</bsdf>",
       R"(<bsdf type="twosided">)" + diffuse + metal + "</bsdf>", metal})));
  expect_same_paths(scene_from_elements(with_materials(
      {R"(<bsdf type="mask"><float name="opacity" value="0.4"/>)" + metal + "</bsdf>", R"(<bsdf type="dielectric"/>)",
       R"(<bsdf type="mask"><float name="opacity" value="0.7"/><bsdf type="twosided">)" + diffuse + "</bsdf></bsdf>",
       R"(<bsdf type="twosided">)" + diffuse + "</bsdf>"})));
}

TEST_F(Structure, RefusesWhatDoesNotFit) {
  const Scene scene = scene_from_elements(R"(<integrator type="path"/>)" + sensor_element(8, 8) +
                                          R"(<shape type="disk"/><emitter type="constant"/>)");
  EXPECT_THROW(render(scene, KernelStructure::kFused), InputError);
}

}  // namespace
}  // namespace tachylite::test
