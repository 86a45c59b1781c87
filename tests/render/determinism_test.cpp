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

// Without such integers other kernels store the rows (shaders/base/queues.glsl). The glass is then shaded by the kernel
// for all materials.
TEST_F(Determinism, DevicesWithoutIntegersOf64Bits) {
  vulkan::Device narrow({.validation = true, .int64 = false});
  ASSERT_FALSE(narrow.info().int64);
  if (!device().info().int64) GTEST_SKIP() << "this device has none";
  const std::string lamp = R"(<shape type="rectangle"><transform name="to_world"><scale value="0.2"/>
<rotate x="1" angle="90"/><translate y="0.9"/></transform>
<emitter type="area"><rgb name="radiance" value="20, 14, 8"/></emitter></shape>)";
  const std::string fog = R"(<medium name="interior" type="homogeneous"><rgb name="sigma_t" value="1, 0.8, 0.5"/>
<rgb name="albedo" value="0.9, 0.8, 0.6"/></medium>)";
  const auto box_with_ball = [&](const std::string& integrator, const std::string& ball) {
    return integrator + sensor_element(32, 32, "0, 0, 0.95", "0, 0, 0", 80) +
           R"(<shape type="cube"><boolean name="flip_normals" value="true"/><bsdf type="diffuse"/></shape>
<shape type="sphere"><float name="radius" value="0.5"/>)" + ball + "</shape>" + lamp;
  };
  const std::string path = R"(<integrator type="path"><integer name="max_depth" value="6"/></integrator>)";
  const std::string volpath = R"(<integrator type="volpath"><integer name="max_depth" value="6"/></integrator>)";
  for (const std::string& elements : {box_with_ball(path, R"(<bsdf type="dielectric"/>)"),
                                      box_with_ball(volpath, R"(<bsdf type="null"/>)" + fog)}) {
    const Scene scene = scene_from_elements(elements);
    RenderOptions options = stages(16, 1 << 14);
    options.guiding = scene.integrator.kind == Integrator::Kind::kPath ? Guiding::kOn : Guiding::kOff;
    const FilmBuffer film = render_on_device(scene, options).film;
    EXPECT_GT(image_mean(film).value.y, 0.05);
    EXPECT_EQ(different_pixels(render_on_device(scene, options, narrow).film, film), 0u);
  }
  for (const std::string& message : narrow.validation_messages()) ADD_FAILURE() << message;
}

}  // namespace
}  // namespace tachylite::test
