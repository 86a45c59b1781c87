// A sun of one texel at 1e8 in a sky of 1, over a diffuse plane whose normal is the map's zenith. The map is bilinear
// in azimuth and polar angle t, rows at distance h: a texel is a tent in both, so with W columns it adds
//   E = (L - 1) 2 pi / W integral of (1 - |t - t0| / h) cos t sin t
//     = (L - 1) 2 pi / W sin(2 t0) sin^2(h) / (2 h) above the horizon, and
//       (L - 1) 2 pi / W (1/4 - sin(2 h) / (8 h)) at the zenith and, half of it being below, on the horizon
// to the irradiance pi of the sky.

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "stress/stress_case.h"

namespace tachylite::test {
namespace {

constexpr int kWidth = 64, kRows = 33, kHorizon = 16;
constexpr double kSun = 1e8, kAlbedo = 0.5;

std::shared_ptr<const Bitmap> map_with_sun(int row) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = kWidth;
  bitmap->height = kRows;
  bitmap->channels = 3;
  bitmap->floats.assign(3 * kWidth * kRows, 1.0f);
  const int texel = row * kWidth + kWidth - 1;  // in the last column: its tent reaches over the seam
  for (int c = 0; c < 3; ++c) bitmap->floats[static_cast<size_t>(3 * texel + c)] = static_cast<float>(kSun);
  return bitmap;
}

double plane_radiance(int row) {
  const double h = M_PI / (kRows - 1), t = row * h;
  double tent = 0;
  if (row == 0 || row == kHorizon) tent = 0.25 - std::sin(2 * h) / (8 * h);
  else if (row < kHorizon) tent = std::sin(2 * t) * std::sin(h) * std::sin(h) / (2 * h);
  return kAlbedo / M_PI * (M_PI + (kSun - 1) * 2 * M_PI / kWidth * tent);
}

/// As mean_beyond_noise; an image whose mean is less certain than `certainty` (relative) cannot tell and is refused.
std::function<double(const FilmBuffer&)> certain_mean(double expected, double certainty) {
  return [=](const FilmBuffer& film) {
    const ImageMean mean = image_mean(film);
    if (!(mean.error.x <= certainty * expected)) return std::numeric_limits<double>::infinity();
    return mean_beyond_noise(glm::dvec3(expected))(film);
  };
}

using EnvironmentSun = DeviceTest;

TEST_F(EnvironmentSun, OneTexelAt1e8) {
  for (const int row : {0, 8, kHorizon, 20}) {
    Scene scene = scene_from_elements(
        R"(<integrator type="direct"/>)" + sensor_element(8, 8, "0, 0, 4", "0, 0, 0", 10) +
        fmt::format(R"(<shape type="rectangle"><transform name="to_world"><scale value="9"/></transform>
<bsdf type="diffuse"><float name="reflectance" value="{}"/></bsdf></shape><emitter type="constant"/>)", kAlbedo));
    // Its y is the world's z.
    const glm::dmat4 to_world(0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1);
    scene.emitters[0] = {{}, "envmap", EnvironmentEmitter{map_with_sun(row), false, 1, to_world}, kNone};
    // Five standard errors of at most 1 %: a bias of 7.4 % is seen with a power of 0.99.
    const double degrees = 180.0 * row / (kRows - 1);
    expect_stress(scene, {.name = fmt::format("sun of one texel at 1e8, {:.1f} degrees from the zenith", degrees),
                          .samples = 512, .bound = 1e-5, .error = certain_mean(plane_radiance(row), 1e-2)});
  }
}

}  // namespace
}  // namespace tachylite::test
