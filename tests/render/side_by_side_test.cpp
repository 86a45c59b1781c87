// Several devices that render one image at the same time: the same image as of one.

#include <algorithm>
#include <atomic>
#include <cstdlib>

#include <gtest/gtest.h>

#include "support/render_test.h"
#include "vulkan/device_pool.h"

namespace tachylite::test {
namespace {

class SideBySide : public DeviceTest {
 protected:
  void TearDown() override {
    for (const std::string& message : pool.validation_messages()) ADD_FAILURE() << message;
    DeviceTest::TearDown();
  }
  FilmBuffer render(const Scene& scene, const RenderOptions& options, uint32_t devices) {
    const PackedScene packed = pack_scene(scene);
    return Renderer(pool.side_by_side(devices), packed, options).render();
  }
  // Of so many devices, and of one. options.samples without limits.
  void expect_same_image(const Scene& scene, const RenderOptions& options, uint32_t devices = 2) {
    const FilmBuffer one = render(scene, options, 1);
    EXPECT_GT(image_mean(one).value.y, 0.01);
    expect_same_film(render(scene, options, devices), one);
  }
  static void expect_same_film(const FilmBuffer& film, const FilmBuffer& expected) {
    ASSERT_EQ(film.is_adaptive(), expected.is_adaptive());
    const Image a = film.to_image(!film.is_adaptive()), b = expected.to_image(!film.is_adaptive());
    EXPECT_EQ(a.channels, b.channels);
    EXPECT_EQ(a.words, b.words);
    EXPECT_EQ(a.metadata, b.metadata);
  }

  vulkan::DevicePool pool{{.validation = true, .kept_pipelines = 32}};
};

RenderOptions options_of(KernelStructure structure, uint64_t samples) {
  RenderOptions options;
  options.samples = samples;
  options.structure = structure;
  options.max_paths = 5000;  // passes of several waves
  return options;
}

// A glass ball under a small lamp, and the same of fog.
Scene ball_scene(const std::string& integrator, const std::string& ball) {
  const std::string depth = R"("><integer name="max_depth" value="6"/></integrator>)";
  return scene_from_elements("<integrator type=\"" + integrator + depth +
                             sensor_element(44, 36, "0, 0, 0.95", "0, 0, 0", 80) + R"(
<shape type="cube"><boolean name="flip_normals" value="true"/><bsdf type="diffuse"/></shape>
<shape type="sphere"><float name="radius" value="0.5"/>)" + ball + R"(</shape>
<shape type="rectangle"><transform name="to_world"><scale value="0.2"/><rotate x="1" angle="90"/>
<translate y="0.9"/></transform><emitter type="area"><rgb name="radiance" value="20, 14, 8"/></emitter></shape>)");
}

TEST_F(SideBySide, Stages) {
  const Scene scene = scene_from_elements(cornell_elements(44));
  expect_same_image(scene, options_of(KernelStructure::kStages, 30));
  expect_same_image(scene, options_of(KernelStructure::kStages, 30), 3);
  RenderOptions whole_images = options_of(KernelStructure::kStages, 30);
  whole_images.max_paths = 1 << 16;
  expect_same_image(scene, whole_images);
}

TEST_F(SideBySide, Fused) {
  expect_same_image(scene_from_elements(cornell_elements(44)), options_of(KernelStructure::kFused, 100));
}

TEST_F(SideBySide, Guide) {
  RenderOptions options = options_of(KernelStructure::kStages, 16);
  options.guiding = Guiding::kOn;
  const Scene scene = ball_scene("path", R"(<bsdf type="dielectric"/>)");
  expect_same_image(scene, options);
  const std::vector<std::string> skipped = render_on_device(scene, options).stages_skipped;
  EXPECT_EQ(std::count(skipped.begin(), skipped.end(), "guide"), 0);
}

TEST_F(SideBySide, Media) {
  expect_same_image(ball_scene("volpath", R"(<bsdf type="null"/><medium name="interior" type="homogeneous">
<rgb name="sigma_t" value="1, 0.8, 0.5"/><rgb name="albedo" value="0.9, 0.8, 0.6"/></medium>)"),
                    options_of(KernelStructure::kStages, 16));
}

TEST_F(SideBySide, Adaptive) {
  RenderOptions options = options_of(KernelStructure::kStages, 96);
  options.adaptive = true;
  const Scene scene = ball_scene("path", R"(<bsdf type="diffuse"/>)");
  ASSERT_TRUE(render(scene, options, 1).is_adaptive());
  expect_same_image(scene, options);
}

// Passes are looked at one after the other, whoever has traced them.
TEST_F(SideBySide, ErrorLimit) {
  RenderOptions options = options_of(KernelStructure::kStages, 4096);
  options.error_limit = 0.1;
  const Scene scene = scene_from_elements(cornell_elements(24));
  const FilmBuffer film = render(scene, options, 2);
  EXPECT_LE(film.relative_error(), options.error_limit);
  ASSERT_LT(film.samples(), 2048u);
  EXPECT_GT(film.relative_error(), 0.8 * options.error_limit);
  options.samples = film.samples();
  options.error_limit = 0;
  expect_same_film(film, render(scene, options, 1));
}

// What there is when the caller says stop are the first samples, without gaps; one thread at a time calls the caller.
TEST_F(SideBySide, StopsWithTheFirstSamples) {
  const Scene scene = scene_from_elements(cornell_elements(44));
  RenderOptions options = options_of(KernelStructure::kStages, 4096);
  options.first_sample = 8;
  for (const int most_calls : {1, 20, 100, 101, 102}) {
    SCOPED_TRACE(most_calls);
    std::atomic<int> inside = 0;
    int calls = 0;
    options.progress = [&](const RenderProgress&) {
      EXPECT_EQ(++inside, 1);
      ++calls;
      --inside;
      return calls < most_calls;
    };
    const FilmBuffer film = render(scene, options, 2);
    EXPECT_EQ(calls, most_calls);
    EXPECT_LT(film.samples(), options.samples);
    ASSERT_TRUE(most_calls < 100 || film.samples() > 0);
    if (film.samples() == 0) continue;
    EXPECT_EQ(film.ranges(), (std::vector<SampleRange>{{8, film.samples()}}));
    RenderOptions same = options;
    same.samples = film.samples();
    same.progress = nullptr;
    expect_same_film(film, render(scene, same, 1));
  }
}

TEST_F(SideBySide, ThreadsAreSharedOut) {
  const auto variable = [] {
    const char* value = std::getenv("LP_NUM_THREADS");
    return std::string(value ? value : "none");
  };
  const std::string before = variable();
  const vulkan::DevicePool::Devices two = pool.side_by_side(2);
  EXPECT_EQ(variable(), before);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_NE(two[0]->handle(), two[1]->handle());
  EXPECT_EQ(pool.side_by_side(2)[1].get(), two[1].get());
  EXPECT_EQ(two[0]->info().name, pool.one().info().name);
}

TEST_F(SideBySide, OnlyLongRendersInStagesOfLlvmpipe) {
  const PackedScene packed = pack_scene(scene_from_elements(cornell_elements(64)));  // 4096 pixels
  const std::string threads = std::to_string(vulkan::llvmpipe_threads());
  const char* const before = std::getenv("LP_NUM_THREADS");
  const auto set_threads = [](const char* value) {
    value ? setenv("LP_NUM_THREADS", value, 1) : unsetenv("LP_NUM_THREADS");
  };
  vulkan::DeviceInfo llvmpipe;
  llvmpipe.driver = "llvmpipe";
  llvmpipe.type = VK_PHYSICAL_DEVICE_TYPE_CPU;
  llvmpipe.device_memory = uint64_t{1} << 34;
  llvmpipe.max_storage_buffer_range = llvmpipe.max_texel_buffer_elements = uint64_t{1} << 27;
  const RenderOptions long_one = options_of(KernelStructure::kStages, 4096);
  set_threads("4");
  EXPECT_EQ(count_devices(llvmpipe, packed, long_one), 4u);
  set_threads("3");
  EXPECT_EQ(count_devices(llvmpipe, packed, long_one), 3u);
  set_threads("1");
  EXPECT_EQ(count_devices(llvmpipe, packed, long_one), 1u);
  set_threads("4");
  RenderOptions options = long_one;
  options.samples = 128;
  EXPECT_EQ(count_devices(llvmpipe, packed, options), 2u);
  options.samples = 127;
  EXPECT_EQ(count_devices(llvmpipe, packed, options), 1u);
  options = long_one;
  options.structure = KernelStructure::kAuto;  // fits one kernel
  EXPECT_EQ(count_devices(llvmpipe, packed, options), 1u);
  options = long_one;
  options.time_limit = 2;
  EXPECT_EQ(count_devices(llvmpipe, packed, options), 1u);
  options.time_limit = 60;
  EXPECT_EQ(count_devices(llvmpipe, packed, options), 4u);
  vulkan::DeviceInfo other = llvmpipe;
  other.driver = "NVIDIA";
  EXPECT_EQ(count_devices(other, packed, long_one), 1u);
  other = llvmpipe;
  other.device_memory = 3 * Renderer::plan_memory(llvmpipe, packed, long_one, 2).total();
  EXPECT_EQ(count_devices(other, packed, long_one), 1u);
  set_threads(before);
  EXPECT_EQ(std::to_string(vulkan::llvmpipe_threads()), threads);
}

}  // namespace
}  // namespace tachylite::test
