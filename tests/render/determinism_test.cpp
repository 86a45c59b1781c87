// The image is a function of scene, seed and number of samples alone.

#include <gtest/gtest.h>

#include "support/render_test.h"

namespace tachylite::test {
namespace {

using Determinism = DeviceTest;

size_t different_pixels(const FilmBuffer& a, const FilmBuffer& b) {
  const size_t pixels = static_cast<size_t>(a.width()) * static_cast<size_t>(a.height());
  size_t different = 0;
  for (size_t i = 0; i < pixels; ++i) different += a.mean(i) != b.mean(i);
  return different;
}

RenderOptions stages(uint64_t samples, uint32_t max_paths) {
  RenderOptions options;
  options.samples = samples;
  options.max_paths = max_paths;
  options.structure = KernelStructure::kStages;
  return options;
}

TEST_F(Determinism, PathsInFlight) {
  // 44 x 44 pixels: tiles at the border are not full.
  const Scene scene = scene_from_elements(cornell_elements(44));
  const DeviceRender whole = render_on_device(scene, stages(16, 1 << 18));
  for (uint32_t max_paths : {256u, 1000u, 4096u, 1u << 14})
    EXPECT_EQ(different_pixels(render_on_device(scene, stages(16, max_paths)).film, whole.film), 0u) << max_paths;
}

TEST_F(Determinism, SamplesNotAMultipleOfABlock) {
  const Scene scene = scene_from_elements(cornell_elements(24));
  for (uint64_t samples : {1u, 3u, 6u})
    EXPECT_EQ(different_pixels(render_on_device(scene, stages(samples, 256)).film,
                               render_on_device(scene, stages(samples, 1 << 18)).film),
              0u);
}

TEST_F(Determinism, SeedsDiffer) {
  const Scene scene = scene_from_elements(cornell_elements(16));
  RenderOptions options = stages(4, 1 << 14);
  const FilmBuffer a = render_on_device(scene, options).film;
  options.seed = 1;
  const FilmBuffer b = render_on_device(scene, options).film;
  // Pixels that see nothing but the open front agree.
  EXPECT_GT(different_pixels(a, b), 16u * 16u / 2);
}

}  // namespace
}  // namespace tachylite::test
