// A texture of alpha whose texels lie on both sides of the threshold of smooth (2e-5), in stripes of one alpha each.
// Under a sky of 1 a mirror shows 1 or its reflectance in all of them, glass F + (1 - F) / eta^2. A sun along the view
// is seen by those that are rough, and by no others.

#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "stress/stress_case.h"

namespace tachylite::test {
namespace {

constexpr std::array kAlphas = {0.0f, 1e-5f, 1.9e-5f, 2.1e-5f, 1e-3f};
constexpr int kStripe = 4;  // pixels across each

/// A rectangle that fills the view of an orthographic camera, turned by `angle` [rad] about x, which stripes run along.
Scene stripes(const std::string& bsdf, double angle, FilterType filter,
              const std::string& light = R"(<emitter type="constant"/>)") {
  const int size = kStripe * static_cast<int>(kAlphas.size());
  Scene scene = scene_from_elements(fmt::format(R"(<integrator type="path"><integer name="max_depth" value="3"/>
<integer name="rr_depth" value="100"/></integrator><sensor type="orthographic"><transform name="to_world">
<lookat origin="0, {}, {}" target="0, 0, 0" up="1, 0, 0"/></transform><film type="hdrfilm">
<integer name="width" value="{}"/><integer name="height" value="{}"/><rfilter type="box"/></film></sensor>
<shape type="rectangle"><transform name="to_world"><scale y="4"/></transform>{}</shape>)",
                                                std::sin(angle), std::cos(angle), size, size, bsdf) + light);
  if (scene.textures.empty()) return scene;
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

/// What becomes of an alpha below 2e-5: the device takes the stripe as smooth, the reference takes any alpha as 1e-4 at
/// least, as Mitsuba does.
enum class SmallAlpha { kSmooth, kClamped };

/// The largest error of a pixel under a sun of irradiance 1 along normal and view, where f = F D / 4 and
/// D = 1 / (pi alpha^2), relative to that; 1 where a smooth stripe shows any light.
std::function<double(const FilmBuffer&)> worst_highlight(double reflectance, const std::vector<float>& alphas,
                                                         SmallAlpha small) {
  return [=](const FilmBuffer& film) {
    double worst = 0;
    const size_t pixels = film.pixels() / alphas.size();  // up is x, which texels run along
    for (size_t i = 0; i < film.pixels(); ++i) {
      double alpha = static_cast<double>(alphas[alphas.size() - 1 - i / pixels]);
      const double value = film.mean(i).x;
      if (small == SmallAlpha::kClamped) alpha = std::max(alpha, 1e-4);
      if (alpha < 2e-5) worst = std::max(worst, value == 0 ? 0.0 : 1.0);
      else worst = std::max(worst, std::abs(value * 4 * M_PI * alpha * alpha / reflectance - 1));
    }
    return worst;
  };
}
void expect_highlight(const std::string& name, const Scene& scene, double reflectance,
                      const std::vector<float>& alphas) {
  expect_stress(scene, {.name = name, .samples = 4, .bound = 1e-5,
                        .error = worst_highlight(reflectance, alphas, SmallAlpha::kSmooth),
                        .reference_error = worst_highlight(reflectance, alphas, SmallAlpha::kClamped)});
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

// The threshold itself: to either side of it, an image is 0 or 2e8.
TEST_F(TexturedAlpha, TheThresholdOfSmooth) {
  const std::string sun = R"(<emitter type="directional"><vector name="direction" x="0" y="0" z="-1"/></emitter>)";
  const std::string glass = R"(<float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/>)";
  const std::vector<float> alphas(kAlphas.begin(), kAlphas.end());
  for (const char* name : {"ggx", "beckmann"}) {
    const std::string mirror = bsdf("roughconductor", distribution(name) + R"(<string name="material" value="none"/>)");
    expect_highlight(fmt::format("sun in a mirror, {}, texels of alpha 0 to 1e-3", name),
                     stripes(mirror, 0, FilterType::kNearest, sun), 1, alphas);
    expect_highlight(fmt::format("sun in glass, {}, texels of alpha 0 to 1e-3", name),
                     stripes(bsdf("roughdielectric", distribution(name) + glass), 0, FilterType::kNearest, sun), 0.04,
                     alphas);
  }
  // Without a texture, packing decides.
  for (const float alpha : {1.9e-5f, 2.1e-5f}) {
    const std::string mirror = fmt::format(R"(<bsdf type="roughconductor"><float name="alpha" value="{}"/>
<string name="material" value="none"/></bsdf>)", alpha);
    expect_highlight(fmt::format("sun in a mirror of alpha {:.1e}", alpha),
                     stripes(mirror, 0, FilterType::kNearest, sun), 1, {alpha});
  }
}

}  // namespace
}  // namespace tachylite::test
