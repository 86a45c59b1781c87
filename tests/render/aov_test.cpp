// Auxiliary channels, on the device and in the reference, against closed forms. An orthographic camera looks straight
// at a row of squares, a material each: values that do not vary within a square are exact to rounding (1e-5).

#include <cmath>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "reference/reference.h"
#include "support/render_test.h"

namespace tachylite::test {
namespace {

using Aovs = DeviceTest;

struct Square {
  std::string bsdf;
  glm::dvec3 albedo;
};

std::vector<Square> squares() {
  const std::string diffuse = R"(<bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.4, 0.6"/></bsdf>)";
  const glm::dvec3 blue(0.2, 0.4, 0.6);
  // A metal at normal incidence: ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2).
  const auto metal = [](double eta, double k) { return (std::pow(eta - 1, 2) + k * k) / (std::pow(eta + 1, 2) + k * k); };
  const std::string indices = R"(<rgb name="eta" value="0.2, 0.9, 1.2"/><rgb name="k" value="3.5, 2.5, 2"/>)";
  const glm::dvec3 copper(metal(0.2, 3.5), metal(0.9, 2.5), metal(1.2, 2));
  return {
      {diffuse, blue},
      {R"(<bsdf type="conductor">)" + indices + "</bsdf>", copper},
      {R"(<bsdf type="roughconductor"><float name="alpha" value="0.01"/>)" + indices +
           R"(<rgb name="specular_reflectance" value="0.5"/></bsdf>)",
       0.5 * copper},
      {R"(<bsdf type="dielectric"/>)", glm::dvec3(1)},
      {R"(<bsdf type="roughplastic"><rgb name="diffuse_reflectance" value="0.2, 0.4, 0.6"/></bsdf>)", blue},
      {R"(<bsdf type="principled"><rgb name="base_color" value="0.2, 0.4, 0.6"/></bsdf>)", blue},
      {R"(<bsdf type="mask"><float name="opacity" value="0.25"/>)" + diffuse + "</bsdf>", 0.25 * blue},
      {R"(<bsdf type="blendbsdf"><float name="weight" value="0.25"/>)" + diffuse +
           R"(<bsdf type="conductor">)" + indices + "</bsdf></bsdf>",
       0.75 * blue + 0.25 * copper},
      {R"(<bsdf type="twosided"><bsdf type="diffuse"/>)" + diffuse + "</bsdf>", glm::dvec3(0.5)},
      {R"(<bsdf type="diffuse"><texture name="reflectance" type="checkerboard"><rgb name="color0" value="0.2, 0.4, 0.6"/>
<rgb name="color1" value="0.2, 0.4, 0.6"/></texture></bsdf>)",
       blue},
      {R"(<bsdf type="null"/>)", glm::dvec3(0)},
  };
}

/// Squares of 4 x 4 pixels next to each other at z = -3, seen from z = 0 with a near clip plane at 0.5.
Scene row_of_squares(const std::string& aovs, const std::string& light = "constant") {
  const size_t count = squares().size();
  std::string elements = fmt::format(
      R"(<integrator type="aov"><string name="aovs" value="{}"/>
<integrator type="path"><integer name="max_depth" value="1"/></integrator></integrator>
<sensor type="orthographic"><float name="near_clip" value="0.5"/><transform name="to_world"><scale x="{}" y="{}"/>
<lookat origin="0, 0, 0" target="0, 0, -1" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="{}"/><integer name="height" value="8"/><rfilter type="box"/></film>
</sensor><emitter type="{}"/>)",
      aovs, count, count, 4 * count, light);
  for (size_t i = 0; i < count; ++i)
    elements += fmt::format(R"(<shape type="rectangle"><transform name="to_world"><translate x="{}" y="0" z="-3"/>
</transform>{}</shape>)",
                            2.0 * static_cast<double>(i) - static_cast<double>(count) + 1.0, squares()[i].bsdf);
  return scene_from_elements(elements);
}

/// wander: how far the mean of 64 positions in a pixel may lie from its middle, in pixels.
void expect_closed_forms(const Image& image, double wander) {
  const auto channel = [&](const std::string& name) -> const std::vector<float>& {
    const std::vector<float>* found = image.find(name);
    EXPECT_NE(found, nullptr) << name;
    static const std::vector<float> kNone;
    return found ? *found : kNone;
  };
  for (const std::string name : {"albedo.R", "normal.X", "normal.Z", "depth.Z", "position.X", "uv.U", "prim_index.I",
                                 "shape_index.I", "sample_count.I", "dd.T", "nn.Y"})
    ASSERT_EQ(channel(name).size(), static_cast<size_t>(image.width * image.height)) << name;
  for (size_t i = 0; i < squares().size(); ++i) {
    SCOPED_TRACE(squares()[i].bsdf);
    // A pixel in the middle of the square: its right border at the square's middle, its lower one at y = 0.
    const size_t x = 4 * i + 1, pixel = 3 * static_cast<size_t>(image.width) + x;
    const glm::dvec3 albedo = squares()[i].albedo;
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(channel(std::string("albedo.") + "RGB"[c])[pixel], albedo[c], 1e-5);
    EXPECT_NEAR(channel("normal.X")[pixel], 0, 1e-6);
    EXPECT_NEAR(channel("normal.Z")[pixel], 1, 1e-6);
    EXPECT_EQ(channel("nn.Y")[pixel], channel("normal.Y")[pixel]);
    EXPECT_NEAR(channel("depth.Z")[pixel], 2.5, 1e-5);
    EXPECT_EQ(channel("dd.T")[pixel], channel("depth.Z")[pixel]);
    EXPECT_EQ(channel("shape_index.I")[pixel], static_cast<float>(i));
    for (const size_t p : {pixel, pixel + 1, pixel + static_cast<size_t>(image.width)})  // in both of its triangles
      EXPECT_EQ(channel("prim_index.I")[p], 0);
    EXPECT_EQ(channel("sample_count.I")[pixel], 64);
    // Those that vary over the pixel, which is 1/2 wide.
    const double left = 2.0 * static_cast<double>(i) - static_cast<double>(squares().size());
    EXPECT_NEAR(channel("position.X")[pixel], left + 0.75, 0.5 * wander);
    EXPECT_NEAR(channel("position.Y")[pixel], 0.25, 0.5 * wander);
    EXPECT_NEAR(channel("position.Z")[pixel], -3, 1e-5);
    EXPECT_NEAR(channel("uv.U")[pixel], 0.375, 0.25 * wander);
    EXPECT_NEAR(channel("uv.V")[pixel], 0.625, 0.25 * wander);
  }
  // Above the squares there is nothing.
  EXPECT_EQ(channel("depth.Z")[0], 0);
  EXPECT_EQ(channel("sample_count.I")[0], 64);
}

const char* const kAll =
    "albedo, normal, depth, position, uv, prim_index, shape_index, sample_count, dd:depth, nn:sh_normal";

TEST_F(Aovs, OnTheDevice) {
  RenderOptions options;
  options.samples = 64;
  expect_closed_forms(render_on_device(row_of_squares(kAll), options).film.to_image(), 0.03);  // stratified
}

// No ray finds the light, and none is sampled: the first hits still count.
TEST_F(Aovs, OfScenesWithoutBounces) {
  RenderOptions options;
  options.samples = 64;
  options.structure = KernelStructure::kStages;
  expect_closed_forms(render_on_device(row_of_squares(kAll, "point"), options).film.to_image(), 0.03);
}

TEST_F(Aovs, InTheReference) {
  ReferenceOptions options;
  options.samples = 64;
  // Independent: the standard deviation is 0.036.
  expect_closed_forms(to_image(render_reference(row_of_squares(kAll), options)), 0.2);
}

TEST_F(Aovs, DoNotChangeTheImage) {
  RenderOptions options;
  options.samples = 8;
  options.structure = KernelStructure::kStages;
  const Scene without = scene_from_elements(cornell_elements(16));
  Scene with = without;
  with.integrator.aovs = {"albedo", "depth"};
  const FilmBuffer a = render_on_device(with, options).film, b = render_on_device(without, options).film;
  for (size_t i = 0; i < static_cast<size_t>(a.width() * a.height()); ++i) ASSERT_EQ(a.mean(i), b.mean(i));
}

}  // namespace
}  // namespace tachylite::test
