// Environment maps in images: a small sun is found without bias, and much better than by BSDF sampling; a constant
// image is the constant emitter.

#include <cmath>

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "support/render_test.h"

namespace tachylite::test {
namespace {

using glm::dvec3;
using Environment = DeviceTest;
using Strategy = Integrator::Strategy;

constexpr int kWidth = 64, kRows = 32, kSize = 32;
constexpr double kReflectance = 0.5;

std::shared_ptr<const Bitmap> bitmap_of(int width, int height, const std::function<dvec3(int x, int y)>& pixel) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = width;
  bitmap->height = height;
  bitmap->channels = 3;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) bitmap->floats.push_back(static_cast<float>(pixel(x, y)[c]));
  return bitmap;
}

/// A floor of normal +y that nothing shades, seen from above, under the map.
Scene floor_under(std::shared_ptr<const Bitmap> bitmap, const glm::dmat4& to_world, Strategy strategy) {
  Scene scene = scene_from_elements(fmt::format(
      R"(<integrator type="path"><integer name="max_depth" value="2"/></integrator>{}<shape type="rectangle">
<transform name="to_world"><scale value="50"/><rotate x="1" angle="-90"/></transform><bsdf type="diffuse">
<rgb name="reflectance" value="{}"/></bsdf></shape><emitter type="constant"/>)",
      sensor_element(kSize, kSize, "0.5, 5, 0", "0, 0, 0", 30), kReflectance));
  scene.emitters[0] = {{}, "envmap", EnvironmentEmitter{std::move(bitmap), false, 1, to_world}, kNone};
  scene.integrator.strategy = strategy;
  return scene;
}

/// rho / pi times the integral of the bilinear map times the cosine over the upper half space, by midpoints of 16 x 16
/// parts of each cell between texels.
double floor_radiance(const Bitmap& bitmap, const glm::dmat4& to_world) {
  constexpr int kParts = 16;
  const dvec3 up = glm::transpose(glm::dmat3(to_world)) * dvec3(0, 1, 0);  // in the map's frame
  const auto texel = [&](int x, int y) {
    return double{bitmap.floats[static_cast<size_t>(3 * (y * kWidth + x % kWidth))]};
  };
  double sum = 0;
  for (int y = 0; y < (kRows - 1) * kParts; ++y)
    for (int x = 0; x < kWidth * kParts; ++x) {
      const double row = (y + 0.5) / kParts, column = (x + 0.5) / kParts;
      const double theta = M_PI * row / (kRows - 1), phi = 2 * M_PI * (column + 0.5) / kWidth;
      const dvec3 d(std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta));
      const int x0 = x / kParts, y0 = y / kParts;
      const double fx = column - x0, fy = row - y0;
      const double value = (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x0 + 1, y0)) +
                           fy * ((1 - fx) * texel(x0, y0 + 1) + fx * texel(x0 + 1, y0 + 1));
      sum += value * std::max(0.0, glm::dot(d, up)) * std::sin(theta);
    }
  const double cell = M_PI / ((kRows - 1) * kParts) * 2 * M_PI / (kWidth * kParts);
  return kReflectance / M_PI * sum * cell;
}

/// Of the pixels against the exact value: mean of the relative error, and of its square.
glm::dvec2 relative_errors(const Scene& scene, double exact, uint64_t samples) {
  RenderOptions options;
  options.samples = samples;
  options.sampler = SamplerKind::kIndependent;
  const FilmBuffer film = render_on_device(scene, options).film;
  glm::dvec2 sums(0);
  constexpr int kPixels = kSize * kSize;
  for (size_t i = 0; i < kPixels; ++i) {
    const double e = film.mean(i).x / exact - 1;
    sums += glm::dvec2(e, e * e) / double{kPixels};
  }
  return sums;
}

// A sun of one texel, 1e5 times the sky. The z-test has a level of 1e-5 and, its standard error being below 0.2 %, sees
// a bias of 1.4 % with a power of 0.99.
TEST_F(Environment, SmallSunIsFoundWithoutBias) {
  const auto bitmap =
      bitmap_of(kWidth, kRows, [](int x, int y) { return dvec3(x == 45 && y == 9 ? 1e5 : 0.7 + 0.01 * ((3 * x + y) % 60)); });
  const glm::dmat4 turn = glm::rotate(glm::rotate(glm::dmat4(1), 2.2, dvec3(0, 1, 0)), 0.4, dvec3(1, 0, 0.5));
  const double exact = floor_radiance(*bitmap, turn);
  ASSERT_GT(exact, 10);  // of which the sky has less than 1
  const uint64_t samples = 16;
  const glm::dvec2 mis = relative_errors(floor_under(bitmap, turn, Strategy::kMis), exact, samples);
  const glm::dvec2 emitter = relative_errors(floor_under(bitmap, turn, Strategy::kEmitterOnly), exact, samples);
  const glm::dvec2 bsdf = relative_errors(floor_under(bitmap, turn, Strategy::kBsdfOnly), exact, samples);
  for (const glm::dvec2& e : {mis, emitter}) {
    const double standard_error = std::sqrt(e.y / (kSize * kSize));
    EXPECT_LT(standard_error, 2e-3);
    EXPECT_LT(std::abs(e.x), 4.42 * standard_error + 1e-4);
  }
  // At equal samples; asked for are 50 times, and its own noise is below a half.
  EXPECT_GT(bsdf.y, 100 * mis.y) << "relMSE " << bsdf.y << " by BSDF sampling, " << mis.y << " by both";
}

// The furnace: radiance rho L, whatever the strategy; and the same as the constant emitter, to rounding.
TEST_F(Environment, ConstantImageIsAFurnace) {
  const dvec3 radiance(1.25);
  for (const glm::ivec2 size : {glm::ivec2(2, 2), glm::ivec2(3, 5), glm::ivec2(64, 32)}) {
    const auto bitmap = bitmap_of(size.x, size.y, [&](int, int) { return radiance; });
    const Scene map = floor_under(bitmap, glm::rotate(glm::dmat4(1), 0.7, dvec3(1, 2, 3)), Strategy::kMis);
    Scene constant = map;
    constant.emitters[0].kind = ConstantEmitter{radiance};
    for (const KernelStructure structure : {KernelStructure::kStages, KernelStructure::kFused}) {
      RenderOptions options;
      options.structure = structure;
      const FilmBuffer a = render_on_device(map, options).film, b = render_on_device(constant, options).film;
      for (size_t i = 0; i < kSize * kSize; ++i) {
        ASSERT_NEAR(a.mean(i).x, b.mean(i).x, 3e-7 * b.mean(i).x);
        ASSERT_NEAR(a.mean(i).x, kReflectance * 1.25, 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace tachylite::test
