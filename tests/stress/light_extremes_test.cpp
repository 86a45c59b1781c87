// Lights at their extremes, on a diffuse plane seen from above: the radiance that leaves it is albedo / pi times an
// irradiance that is known.

#include <cmath>

#include <fmt/format.h>

#include "stress/stress_case.h"

namespace tachylite::test {
namespace {

constexpr double kAlbedo = 0.5;

// A plane of side 2 `half` at z = 0, of which the camera sees the middle 2e-3 half.
std::string plane(double half = 1, int size = 8) {
  return fmt::format(R"(<integrator type="direct"/><sensor type="perspective"><float name="fov" value="0.1145"/>
<float name="near_clip" value="{}"/><float name="far_clip" value="{}"/><transform name="to_world">
<lookat origin="0, 0, {}" target="0, 0, 0" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="{}"/><integer name="height" value="{}"/><rfilter type="box"/></film></sensor>
<shape type="rectangle"><transform name="to_world"><scale value="{}"/></transform><bsdf type="diffuse">
<float name="reflectance" value="{}"/></bsdf></shape>
)", 1e-3 * half, 1e3 * half, half, size, size, half, kAlbedo);
}

std::function<double(const FilmBuffer&)> black() {
  return [](const FilmBuffer& film) {
    double largest = 0;
    for (size_t i = 0; i < film.pixels(); ++i)
      for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(film.mean(i)[c]));
    return largest;
  };
}

void expect_black(const std::string& name, const std::string& lights,
                  const std::vector<std::pair<std::string, std::string>>& files = {}) {
  expect_stress(scene_from_elements(plane() + lights, files), {.name = name, .samples = 8, .bound = 0, .error = black()});
}

using LightExtremes = DeviceTest;

TEST_F(LightExtremes, PointLights) {
  // E = I / h^2 straight below.
  for (const auto& [intensity, height] : {std::pair(1e-20, 1e-4), {1e20, 1e-2}, {1.0, 0.9}}) {
    const double half = 10 * height;
    expect_stress(scene_from_elements(plane(half, 4) + fmt::format(R"(<emitter type="point">
<point name="position" x="0" y="0" z="{}"/><float name="intensity" value="{}"/></emitter>)", height, intensity)),
                    {.name = fmt::format("point light of {:.0e} at {:.0e}", intensity, height), .samples = 4,
                     // Across the view (2e-3 half) the irradiance falls by cos^3: 1.5 (2e-2)^2.
                     .bound = 8e-4, .error = worst_pixel(kAlbedo / M_PI * intensity / (height * height))});
  }
}

TEST_F(LightExtremes, LightsThatShineNothingOnIt) {
  expect_black("point light behind", R"(<emitter type="point"><point name="position" z="-1"/></emitter>)");
  expect_black("point light in the plane of the surface", R"(<emitter type="point"><point name="position" x="0.5"/></emitter>)");
  expect_black("sun along the surface", R"(<emitter type="directional"><vector name="direction" x="1" y="0" z="0"/></emitter>)");
  expect_black("area light that faces away", R"(<shape type="rectangle"><transform name="to_world"><translate x="3" z="1"/>
</transform><emitter type="area"/></shape>)");
  expect_black("black sky", R"(<emitter type="constant"><float name="radiance" value="0"/></emitter>)");
  expect_black("black area light", R"(<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="180"/>
<translate x="3" z="1"/></transform><emitter type="area"><float name="radiance" value="0"/></emitter></shape>)");
}

TEST_F(LightExtremes, SmallInTheHemisphere) {
  // A sphere of radius r at height h straight above: E = pi L (r / h)^2. Seen as (r / h)^2 / 2 of the hemisphere.
  for (const auto& [r, radiance] : {std::pair(1e-1, 1e-20), {1.4e-3, 1.0}, {1e-5, 1e20}})
    expect_stress(scene_from_elements(plane(1, 4) + fmt::format(R"(<shape type="sphere"><point name="center" z="2"/>
<float name="radius" value="{}"/><emitter type="area"><float name="radiance" value="{}"/></emitter></shape>)", 2 * r, radiance)),
                    {.name = fmt::format("sphere of {:.0e} of the hemisphere, radiance {:.0e}", r * r / 2, radiance), .samples = 64,
                     .bound = 1e-5, .error = mean_beyond_noise(glm::dvec3(kAlbedo * radiance * r * r))});
}

}  // namespace
}  // namespace tachylite::test
