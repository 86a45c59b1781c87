// A texture of alpha whose texels lie on both sides of the threshold of smooth (2e-5), under a sky of 1. Stripes of one
// alpha each; a mirror shows 1 or its reflectance in all of them, glass F + (1 - F) / eta^2.

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "stress/stress_case.h"

namespace tachylite::test {
namespace {

constexpr std::array kAlphas = {0.0f, 1e-5f, 1.9e-5f, 2.1e-5f, 1e-3f};
constexpr int kStripe = 4;  // pixels across each

/// A rectangle that fills the view of an orthographic camera, turned by `angle` [rad] about x, which stripes run along.
Scene stripes(const std::string& bsdf, double angle, FilterType filter) {
  const int size = kStripe * static_cast<int>(kAlphas.size());
  Scene scene = scene_from_elements(fmt::format(R"(<integrator type="path"><integer name="max_depth" value="3"/>
<integer name="rr_depth" value="100"/></integrator><sensor type="orthographic"><transform name="to_world">
<lookat origin="0, {}, {}" target="0, 0, 0" up="1, 0, 0"/></transform><film type="hdrfilm">
<integer name="width" value="{}"/><integer name="height" value="{}"/><rfilter type="box"/></film></sensor>
<shape type="rectangle"><transform name="to_world"><scale y="4"/></transform>{}</shape><emitter type="constant"/>)",
                                                std::sin(angle), std::cos(angle), size, size, bsdf));
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = static_cast<int>(kAlphas.size());
  bitmap->height = 1;
  bitmap->channels = 1;
  bitmap->floats.assign(kAlphas.begin(), kAlphas.end());
  scene.textures[0].kind = BitmapTexture{std::move(bitmap), TexelFormat::kFloat, true, WrapMode::kClamp, filter};
  return scene;
}
std::string bsdf(const std::string& type, const std::string& more) {
  return fmt::format(R"(<bsdf type="{}">{}<texture name="alpha" type="checkerboard"/></bsdf>)", type, more);
}
std::string distribution(const char* name) { return fmt::format(R"(<string name="distribution" value="{}"/>)", name); }

/// The worst stripe: relative error of its mean beyond five standard errors.
std::function<double(const FilmBuffer&)> worst_stripe(double expected) {
  return [expected](const FilmBuffer& film) {
    double worst = 0;
    const int width = film.width(), pixels = kStripe * width;
    for (size_t stripe = 0; stripe < kAlphas.size(); ++stripe) {
      double mean = 0, variance = 0;
      for (int i = 0; i < pixels; ++i) {  // up is x: a stripe is a run of rows
        const size_t pixel = stripe * static_cast<size_t>(pixels) + static_cast<size_t>(i);
        mean += film.mean(pixel).x / pixels;
        variance += film.variance_of_mean(pixel).x / pixels / pixels;
      }
      worst = std::max(worst, std::max(std::abs(mean - expected) - 5 * std::sqrt(variance), 0.0) / expected);
    }
    return worst;
  };
}

using TexturedAlpha = DeviceTest;

TEST_F(TexturedAlpha, Conductors) {
  // The reference samples the sky, too.
  for (const auto& [name, filter] : {std::pair("ggx", FilterType::kBilinear), {"beckmann", FilterType::kNearest}}) {
    const std::string mirror = bsdf("roughconductor", distribution(name) + R"(<string name="material" value="none"/>)");
    expect_stress(stripes(mirror, 1, filter),
                  {.name = fmt::format("mirror, {}, texels of alpha 0 to 1e-3", name), .samples = 16, .bound = 1e-5,
                   .error = worst_pixel(1), .reference_error = worst_stripe(1)});
  }
  // At normal incidence facets change the reflectance by O(alpha^2).
  const double eta = 0.2, k = 3.9, f = ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
  expect_stress(stripes(bsdf("roughconductor", distribution("ggx") + fmt::format(
                    R"(<float name="eta" value="{}"/><float name="k" value="{}"/>)", eta, k)), 0, FilterType::kNearest),
                {.name = "conductor, ggx, texels of alpha 0 to 1e-3", .samples = 16, .bound = 1e-5,
                 .error = worst_pixel(f), .reference_error = worst_stripe(f)});
}

TEST_F(TexturedAlpha, Dielectric) {
  const double eta = 1.5, f = (eta - 1) * (eta - 1) / ((eta + 1) * (eta + 1));
  expect_stress(stripes(bsdf("roughdielectric", distribution("ggx") + R"(<float name="int_ior" value="1.5"/>
<float name="ext_ior" value="1"/>)"), 0, FilterType::kNearest),
                {.name = "glass, ggx, texels of alpha 0 to 1e-3", .samples = 256, .bound = 1e-5,
                 .error = worst_stripe(f + (1 - f) / (eta * eta))});
}

}  // namespace
}  // namespace tachylite::test
