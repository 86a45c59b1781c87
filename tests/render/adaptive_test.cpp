// Adaptive sampling on the device: more samples where the image is noisier, for an image that is expected to be the
// same. That it has no bias is tested in unit/adaptive_sampling_test.cpp.

#include <gtest/gtest.h>

#include "image/compare.h"
#include "support/render_test.h"

namespace tachylite::test {
namespace {

using Adaptive = DeviceTest;

// The left half is lit by the sky alone and sees nothing else, the right by a small lamp that paths must find.
Scene uneven_scene() {
  return scene_from_elements(R"(<integrator type="aov"><string name="aovs" value="a:albedo,d:depth"/>
<integrator type="path"><integer name="max_depth" value="4"/></integrator></integrator>)" + sensor_element(36, 28) +
                             R"(<shape type="rectangle"><transform name="to_world"><translate x="-1"/></transform>
<bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf><emitter type="area"/></shape>
<shape type="rectangle"><transform name="to_world"><translate x="1"/></transform><bsdf type="roughconductor">
<float name="alpha" value="0.6"/></bsdf></shape><emitter type="constant"/>
<shape type="sphere"><point name="center" x="2" z="3"/><float name="radius" value="0.5"/><emitter type="area">
<rgb name="radiance" value="20"/></emitter></shape>)");
}

RenderOptions options_of(KernelStructure structure, bool adaptive, uint64_t samples = 128) {
  RenderOptions options;
  options.samples = samples;
  options.structure = structure;
  options.adaptive = adaptive;
  return options;
}

TEST_F(Adaptive, GivesMoreToNoisyPixels) {
  const FilmBuffer film = render_on_device(uneven_scene(), options_of(KernelStructure::kStages, true)).film;
  ASSERT_TRUE(film.is_adaptive());
  EXPECT_NEAR(film.mean_samples(), 128, 2);
  double left = 0, right = 0;
  for (int y = 10; y < 18; ++y)
    for (int x = 0; x < 8; ++x) {
      left += static_cast<double>(film.samples_of(static_cast<size_t>(y * 36 + 6 + x))) / 64;
      right += static_cast<double>(film.samples_of(static_cast<size_t>(y * 36 + 22 + x))) / 64;
    }
  EXPECT_EQ(left, 32);  // the pilot: there is no noise
  EXPECT_GT(right, 160);
}

void expect_same_image(const Image& a, const Image& b) {
  const Comparison comparison = compare_images(a, b, layer_variance(a, b));
  EXPECT_TRUE(comparison.agree()) << describe(comparison);
  for (const MeanTest& mean : comparison.test->means) EXPECT_LT(mean.detectable, 0.02);
}

TEST_F(Adaptive, TheImageOfOneKernelIsTheSame) {
  const Scene scene = scene_from_elements(cornell_elements(32));
  RenderOptions options = options_of(KernelStructure::kFused, false, 512);
  options.seed = 1;
  const FilmBuffer adaptive = render_on_device(scene, options_of(KernelStructure::kFused, true, 512)).film;
  ASSERT_TRUE(adaptive.is_adaptive());
  EXPECT_NEAR(adaptive.mean_samples(), 512, 8);
  expect_same_image(adaptive.to_image(), render_on_device(scene, options).film.to_image());
}

TEST_F(Adaptive, TheImageIsTheSame) {
  const Scene scene = uneven_scene();
  RenderOptions options = options_of(KernelStructure::kStages, false);
  options.seed = 1;
  const Image plain = render_on_device(scene, options).film.to_image();
  const Image adaptive = render_on_device(scene, options_of(KernelStructure::kStages, true)).film.to_image();
  expect_same_image(adaptive, plain);
  // Auxiliary channels are means over the pixel's own number of samples.
  for (const char* name : {"a.R", "a.G", "a.B"}) {
    const std::vector<float>&a = *adaptive.find(name), &b = *plain.find(name);
    double difference = 0;
    for (size_t i = 0; i < a.size(); ++i) difference += std::abs(a[i] - b[i]) / static_cast<double>(a.size());
    EXPECT_LT(difference, 0.01) << name;
  }
}

TEST_F(Adaptive, IsAFunctionOfSceneSeedAndSamples) {
  const Scene scene = uneven_scene();
  RenderOptions options = options_of(KernelStructure::kStages, true, 64);
  const FilmBuffer whole = render_on_device(scene, options).film;
  options.max_paths = 1000;
  const FilmBuffer parts = render_on_device(scene, options).film;
  for (size_t i = 0; i < whole.pixels(); ++i) {
    EXPECT_EQ(parts.samples_of(i), whole.samples_of(i));
    EXPECT_EQ(parts.mean(i), whole.mean(i));
  }
}

TEST_F(Adaptive, EndsAtItsLimits) {
  const Scene scene = uneven_scene();
  RenderOptions options = options_of(KernelStructure::kStages, true, 1 << 14);
  options.error_limit = 0.02;
  const FilmBuffer film = render_on_device(scene, options).film;
  EXPECT_LE(film.relative_error(), options.error_limit);
  EXPECT_GT(film.relative_error(), 0.6 * options.error_limit);
  EXPECT_TRUE(film.is_adaptive());
}

TEST_F(Adaptive, FewSamplesAreAllPilot) {
  const FilmBuffer film = render_on_device(uneven_scene(), options_of(KernelStructure::kStages, true, 10)).film;
  EXPECT_FALSE(film.is_adaptive());
  EXPECT_EQ(film.samples(), 10u);
}

}  // namespace
}  // namespace tachylite::test
