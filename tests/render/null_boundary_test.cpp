// Null surfaces that hold nothing: shadow rays through them end at the light that they were aimed at, and what is
// hidden from the camera is hidden behind them, too.

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reference/reference.h"
#include "support/render_test.h"

namespace tachylite::test {
namespace {

using NullBoundary = DeviceTest;
using glm::dvec3;

constexpr int kSize = 16;
constexpr double kHalf = 0.05, kHeight = 2, kReflectance = 0.5, kRadiance = 100;
const dvec3 kSeen(0.3, 0.1, 0);  // the point of the wall that all pixels show

/// A wall in the plane z = 0 under a small lamp, seen past the null cubes between the two.
Scene wall_under_lamp(const char* integrator, const std::vector<double>& cubes) {
  std::string elements = fmt::format(R"(<integrator type="{}"><integer name="max_depth" value="2"/></integrator>{}
<shape type="rectangle"><transform name="to_world"><scale value="4"/></transform>
<bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf></shape>
<shape type="rectangle"><transform name="to_world"><scale value="{}"/><rotate x="1" angle="180"/><translate z="{}"/>
</transform><emitter type="area"><rgb name="radiance" value="{}"/></emitter></shape>)",
                                     integrator, sensor_element(kSize, kSize, "2, 0.1, 0.3", "0.3, 0.1, 0", 1e-3),
                                     kReflectance, kHalf, kHeight, kRadiance);
  for (const double half : cubes)
    elements += fmt::format(R"(<shape type="cube"><transform name="to_world"><scale value="{}"/>
<rotate x="1" y="0.4" angle="11"/><translate z="1.2"/></transform><bsdf type="null"/></shape>)", half);
  return scene_from_elements(elements);
}

/// Light of the lamp reflected at kSeen by the midpoint rule.
double quadrature() {
  constexpr int kSteps = 64;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double x = kHalf * (2 * (i + 0.5) / kSteps - 1), y = kHalf * (2 * (j + 0.5) / kSteps - 1);
      const dvec3 to = dvec3(x, y, kHeight) - kSeen;
      const double r2 = glm::dot(to, to);
      sum += to.z * to.z / (r2 * r2);
    }
  return kReflectance / std::numbers::pi * kRadiance * sum * 4 * kHalf * kHalf / (kSteps * kSteps);
}

struct Mean {
  double value = 0, deviation = 0;
};
/// Of all pixels, which have one expectation.
Mean mean_of(const FilmBuffer& film) {
  constexpr size_t kPixels = kSize * kSize;
  Mean mean;
  double squares = 0;
  for (size_t i = 0; i < kPixels; ++i) {
    mean.value += film.mean(i).x / kPixels;
    squares += film.mean(i).x * film.mean(i).x / kPixels;
  }
  mean.deviation = std::sqrt(std::max(squares - mean.value * mean.value, 0.0) / kPixels);
  return mean;
}

// 5 deviations: 6e-7 each. They must be below 0.2 %, so that a loss of 2 % of the shadow rays is beyond 10 of them.
void expect_mean(const Mean& mean, const std::string& of) {
  const double expected = quadrature();
  EXPECT_NEAR(mean.value, expected, 5 * mean.deviation + 1e-4 * expected) << of;
  EXPECT_LE(mean.deviation, 0.002 * expected) << of;
}

TEST_F(NullBoundary, ShadowRaysStopShortOfTheirLight) {
  for (const Scene& scene : {wall_under_lamp("path", {}), wall_under_lamp("volpath", {0.4, 0.3, 0.2, 0.1})}) {
    const std::string name = fmt::format("{} shapes", scene.shapes.size());
    RenderOptions device_options;
    device_options.samples = 64;
    const DeviceRender rendered = render_on_device(scene, device_options);
    EXPECT_EQ(rendered.statistics.nonfinite + rendered.statistics.overflow, 0u);
    expect_mean(mean_of(rendered.film), "device, " + name);
    ReferenceOptions options;
    options.samples = 128;
    expect_mean(mean_of(render_reference(scene, options).film), "reference, " + name);
  }
}

// hide_emitters: the camera sees a wall in the sun through lamps that face it, whose light does not reach the wall. One
// sends its light in one direction only, which no ray finds: it is taken away all the same.
TEST_F(NullBoundary, LampsBehindThemAreHidden) {
  const Scene scene = scene_from_elements(
      R"(<integrator type="volpath"><integer name="max_depth" value="2"/><boolean name="hide_emitters" value="true"/>
</integrator>)" + sensor_element(8, 8, "0, 0, 5", "0, 0, 0", 5) +
      R"(<shape type="cube"><transform name="to_world"><scale value="0.4"/><rotate x="1" y="1" angle="20"/>
<translate z="3"/></transform><bsdf type="null"/></shape>
<shape type="rectangle"><transform name="to_world"><translate z="1"/></transform>
<emitter type="area"><rgb name="radiance" value="7"/></emitter></shape>
<shape type="disk"><transform name="to_world"><scale value="0.8"/><translate z="1.5"/></transform>
<emitter type="directionalarea"><rgb name="radiance" value="7"/></emitter></shape>
<shape type="rectangle"><transform name="to_world"><scale value="9"/></transform>
<bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf></shape>
<emitter type="directional"><vector name="direction" value="4, 0, -3"/><rgb name="irradiance" value="2"/></emitter>)");
  const double expected = 0.5 / std::numbers::pi * 2 * 0.6;
  RenderOptions device_options;
  device_options.samples = 8;
  const DeviceRender rendered = render_on_device(scene, device_options);
  for (size_t i = 0; i < 64; ++i)
    EXPECT_NEAR(rendered.film.mean(i).x, expected, 1e-5 * expected) << "device, pixel " << i;
  // The reference chooses between lamp and sun by chance: 0.55 % of deviation. Were the lamp seen, or dark, nothing of
  // the wall would be.
  ReferenceOptions options;
  options.samples = 512;
  const FilmBuffer reference = render_reference(scene, options).film;
  double mean = 0;
  for (size_t i = 0; i < 64; ++i) mean += reference.mean(i).x / 64;
  EXPECT_NEAR(mean, expected, 0.03 * expected) << "reference";
}

// What a pane lets straight through passes its normal map like any lobe (Mitsuba 3.7.1): Fresnel's term is that of the
// map's normal n, the shadowing function holds, and nothing passes where n and the surface have the ray on two sides.
TEST_F(NullBoundary, NormalMapsShadePanes) {
  const dvec3 wo = glm::normalize(dvec3(3, 0, 1));
  for (const dvec3& n : {dvec3(0.8, 0, 0.6), dvec3(0, 0, -1)}) {
    const dvec3 rgb = 0.5 * (n + 1.0);
    const std::string color = fmt::format("{}, {}, {}", rgb.x, rgb.y, rgb.z);
    const Scene scene = scene_from_elements(
        R"(<integrator type="path"><integer name="max_depth" value="2"/></integrator>)" +
        sensor_element(kSize, kSize, "3, 0, 1", "0, 0, 0", 1e-3) +
        fmt::format(R"(<emitter type="constant"/><shape type="rectangle"><bsdf type="normalmap">
<texture name="normalmap" type="checkerboard"><rgb name="color0" value="{0}"/><rgb name="color1" value="{0}"/></texture>
<bsdf type="thindielectric"><float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/>
<rgb name="specular_reflectance" value="0"/></bsdf></bsdf></shape>)", color));
    // Born and Wolf, 1.5.2 (20) and (21), and Conty Estevez et al. 2019, eq. 3 and 4.
    const double c = glm::dot(wo, n), c_t = std::sqrt(1 - (1 - c * c) / 2.25);
    const double r_s = (c - 1.5 * c_t) / (c + 1.5 * c_t), r_p = (1.5 * c - c_t) / (1.5 * c + c_t);
    const double r = (r_s * r_s + r_p * r_p) / 2, alpha2 = 0.125 * n.x * n.x / (n.z * n.z);
    const double shadowing = 2 / (1 + std::sqrt(1 + alpha2 * 9));
    const double expected = wo.z * c > 0 ? (1 - 2 * r / (1 + r)) * shadowing : 0;
    // Passing or not is chance: 0.12 % of deviation, so that five of them see a change of 1.2 % in all but surely.
    const double tolerance = 0.006 * expected;
    RenderOptions device_options;
    device_options.samples = 256;
    EXPECT_NEAR(mean_of(render_on_device(scene, device_options).film).value, expected, tolerance) << "device, " << n.z;
    ReferenceOptions options;
    options.samples = 256;
    EXPECT_NEAR(mean_of(render_reference(scene, options).film).value, expected, tolerance) << "reference, " << n.z;
  }
}

}  // namespace
}  // namespace tachylite::test
