// Cameras against closed forms: the circle of confusion of a thin lens, the edges of an orthographic image, and crops.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "support/render_test.h"

namespace tachylite::test {
namespace {

using Sensors = DeviceTest;

std::string sensor(const std::string& type, const std::string& parameters, const std::string& film,
                   const std::string& scale = "") {
  return fmt::format(R"(<sensor type="{}">{}<transform name="to_world">{}
<lookat origin="0, 0, 0" target="0, 0, -1" up="0, 1, 0"/></transform><film type="hdrfilm"><rfilter type="box"/>{}</film>
</sensor>)",
                     type, parameters, scale, film);
}
std::string film_size(int width, int height) {
  return fmt::format(R"(<integer name="width" value="{}"/><integer name="height" value="{}"/>)", width, height);
}
std::string crop_window(int x, int y, int width, int height) {
  return fmt::format(R"(<integer name="crop_offset_x" value="{}"/><integer name="crop_offset_y" value="{}"/>
<integer name="crop_width" value="{}"/><integer name="crop_height" value="{}"/>)",
                     x, y, width, height);
}
const std::string kLens = R"(<float name="fov" value="40"/><float name="aperture_radius" value="0.3"/>
<float name="focus_distance" value="4"/>)";

constexpr int kSize = 64;
constexpr double kAperture = 0.3, kFocus = 4;
const double kPixels = kSize / (2 * kFocus * std::tan(0.5 * 40 * M_PI / 180));  // a unit of the plane of focus

/// Sum and, of the distribution of light over the film, mean and variance along x and y, in pixels.
struct Spot {
  double sum = 0;
  glm::dvec2 mean{0}, variance{0};
};
Spot spot_of(const FilmBuffer& film) {
  Spot spot;
  glm::dvec2 squares(0);
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const double w = film.mean(static_cast<size_t>(y * film.width() + x)).x;
      const glm::dvec2 p(x + 0.5, y + 0.5);
      spot.sum += w;
      spot.mean += w * p;
      squares += w * p * p;
    }
  spot.mean /= spot.sum;
  spot.variance = squares / spot.sum - spot.mean * spot.mean;
  return spot;
}

/// A glowing disk that faces the camera at depth z, beside the axis.
Scene disk_before_lens(double radius, double z) {
  return scene_from_elements(
      R"(<integrator type="path"><integer name="max_depth" value="1"/></integrator>)" +
      sensor("thinlens", kLens, film_size(kSize, kSize)) +
      fmt::format(R"(<shape type="disk"><transform name="to_world"><scale value="{}"/><translate x="0.1" y="-0.2" z="{}"/>
</transform><emitter type="area"/></shape>)",
                  radius, -z));
}

// A disk of radius r at depth z covers r f / z of the plane of focus at depth f, and each of its points a disk of radius
// A |z - f| / z, A the lens's radius. A uniform disk of radius c has the variance c^2 / 4 along each axis, that of a
// pixel is 1/12, and those of independent spreads add. The light on the film is that of a pinhole's image, wherever the
// focus is. Mean and standard error of 10 renders; level of the 10 t-tests together: 4e-4 (|t| < 7.5, 9 degrees of
// freedom); power 0.99 for errors of 5 % of the variance (2.5 % of the circle's radius).
TEST_F(Sensors, CircleOfConfusion) {
  constexpr int kRenders = 10;
  for (const double z : {2.0, 8.0}) {
    SCOPED_TRACE(z);
    const double radius = 0.025 * z;
    const Scene scene = disk_before_lens(radius, z);
    std::vector<Spot> spots;
    RenderOptions options;
    options.samples = 256;
    for (int i = 0; i < kRenders; ++i) {
      options.seed = static_cast<uint32_t>(i);
      spots.push_back(spot_of(render_on_device(scene, options).film));
    }
    const double circle = kAperture * std::abs(z - kFocus) / z, image = radius * kFocus / z;
    const double variance = 0.25 * (circle * circle + image * image) * kPixels * kPixels + 1 / 12.0;
    const std::array<double, 5> exact = {M_PI * image * image * kPixels * kPixels,
                                         kSize / 2 + 0.1 * kFocus / z * kPixels, kSize / 2 + 0.2 * kFocus / z * kPixels,
                                         variance, variance};
    for (size_t k = 0; k < exact.size(); ++k) {
      double sum = 0, squares = 0;
      for (const Spot& s : spots) {
        const std::array<double, 5> values = {s.sum, s.mean.x, s.mean.y, s.variance.x, s.variance.y};
        sum += values[k] / kRenders;
        squares += values[k] * values[k] / kRenders;
      }
      const double error = std::sqrt(std::max(0.0, squares - sum * sum) / (kRenders - 1));
      EXPECT_LT(error, 5e-3 * exact[k]) << k;
      EXPECT_NEAR(sum, exact[k], 7.5 * error + 1e-6 * exact[k]) << k;
    }
  }
}

// In focus the disk is sharp: pixels inside its image see it with every sample, those outside never.
TEST_F(Sensors, NothingIsBlurredInFocus) {
  constexpr double kRadius = 0.2;
  RenderOptions options;
  const FilmBuffer film = render_on_device(disk_before_lens(kRadius, kFocus), options).film;
  const glm::dvec2 centre(kSize / 2 + 0.1 * kPixels, kSize / 2 + 0.2 * kPixels);
  int inside = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double distance = glm::length(glm::dvec2(x + 0.5, y + 0.5) - centre), rim = kRadius * kPixels;
      const double value = film.mean(static_cast<size_t>(kSize * y + x)).x;
      if (distance < rim - 0.71) {
        ASSERT_EQ(value, 1) << x << ", " << y;
        ++inside;
      } else if (distance > rim + 0.71) {
        ASSERT_EQ(value, 0) << x << ", " << y;
      }
    }
  EXPECT_GT(inside, 20);
}

// A glowing rectangle whose borders are borders of pixels: those inside see it with every sample, the others never.
TEST_F(Sensors, OrthographicImageHasExactEdges) {
  const Scene scene = scene_from_elements(
      R"(<integrator type="path"><integer name="max_depth" value="1"/></integrator>)" +
      sensor("orthographic", "", film_size(32, 24), R"(<scale x="4" y="4"/>)") +
      R"(<shape type="rectangle"><transform name="to_world"><scale x="1.5" y="0.5"/><translate x="0.5" y="1" z="-7"/>
</transform><emitter type="area"><rgb name="radiance" value="3"/></emitter></shape>)");
  // A pixel is 1/4 wide, the film [-4, 4] x [-3, 3], the rectangle [-1, 2] x [0.5, 1.5].
  const FilmBuffer film = render_on_device(scene, RenderOptions()).film;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x) {
      const bool inside = x >= 12 && x < 24 && y >= 6 && y < 10;
      ASSERT_EQ(film.mean(static_cast<size_t>(32 * y + x)).x, inside ? 3.0 : 0.0) << x << ", " << y;
    }
}

// A crop of the image is the image of the crop, bit for bit: tiles, waves and samples do not show.
TEST_F(Sensors, CropsArePartsOfTheImage) {
  const std::string room = R"(<integrator type="path"><integer name="max_depth" value="3"/></integrator>
<shape type="rectangle"><transform name="to_world"><scale value="3"/><translate z="-6"/></transform></shape>
<shape type="sphere"><point name="center" x="0.3" y="0.2" z="-5"/></shape><emitter type="constant"/>
<emitter type="point"><point name="position" x="2" y="2" z="-3"/></emitter>)";
  const std::string fov = R"(<float name="fov" value="50"/><string name="fov_axis" value="diagonal"/>
<float name="principal_point_offset_x" value="0.1"/>)";
  const std::array<std::array<std::string, 3>, 3> cameras = {
      {{"perspective", fov, ""}, {"thinlens", kLens, ""}, {"orthographic", "", R"(<scale x="2" y="2"/>)"}}};
  for (const auto& [type, parameters, scale] : cameras) {
    for (const KernelStructure structure : {KernelStructure::kStages, KernelStructure::kFused}) {
      SCOPED_TRACE(type);
      const auto image = [&](const std::string& window) {
        RenderOptions options;
        options.samples = 8;
        options.structure = structure;
        return render_on_device(scene_from_elements(room + sensor(type, parameters, film_size(37, 27) + window, scale)),
                                options)
            .film;
      };
      const FilmBuffer whole = image(""), part = image(crop_window(11, 5, 19, 13));
      ASSERT_EQ(part.width(), 19);
      for (int y = 0; y < 13; ++y)
        for (int x = 0; x < 19; ++x)
          ASSERT_EQ(part.mean(static_cast<size_t>(19 * y + x)), whole.mean(static_cast<size_t>(37 * (y + 5) + x + 11)))
              << x << ", " << y;
    }
  }
}

// Sensors of one file are numbered from 0 in its order.
TEST_F(Sensors, SeveralInAFile) {
  const Scene scene = scene_from_elements(sensor("perspective", "", film_size(8, 6)) +
                                          sensor("orthographic", "", film_size(5, 4)) + R"(<emitter type="constant"/>)");
  EXPECT_EQ(pack_scene(scene, 0).params.width, 8u);
  EXPECT_EQ(pack_scene(scene, 1).params.width, 5u);
  EXPECT_EQ(pack_scene(scene, 1).features.camera, gpu::kCameraOrthographic);
}

}  // namespace
}  // namespace tachylite::test
