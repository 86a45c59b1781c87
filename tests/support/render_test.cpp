#include "support/render_test.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "reference/reference.h"
#include "scene/load_xml.h"

namespace tachylite::test {
namespace {

constexpr uint64_t kEndOfSamples = 16384;

}  // namespace

Scene scene_from_elements(const std::string& elements,
                          const std::vector<std::pair<std::string, std::string>>& files) {
  static int count = 0;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("tachylite_test_{}_{}", getpid(), count++);
  std::filesystem::create_directory(folder);
  for (const auto& [name, content] : files) std::ofstream(folder / name, std::ios::binary) << content;
  std::ofstream(folder / "scene.xml") << "<scene version=\"3.0.0\">\n" << elements << "\n</scene>\n";
  Scene scene = load_scene(folder / "scene.xml");
  std::filesystem::remove_all(folder);
  return scene;
}

std::string sensor_element(int width, int height, const std::string& origin, const std::string& target, double fov) {
  return fmt::format(
      R"(<sensor type="perspective"><float name="fov" value="{}"/>
<transform name="to_world"><lookat origin="{}" target="{}" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="{}"/><integer name="height" value="{}"/><rfilter type="box"/></film>
</sensor>
)",
      fov, origin, target, width, height);
}

std::string cornell_elements(int size, int max_depth) {
  const auto wall = [](const char* color, const std::string& transform) {
    return fmt::format(R"(<shape type="rectangle"><transform name="to_world">{}</transform>
<bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf></shape>
)",
                       transform, color);
  };
  const auto box = [](const char* scale, double turn, const char* place) {
    return fmt::format(R"(<shape type="cube"><transform name="to_world"><scale {}/><rotate y="1" angle="{}"/>
<translate {}/></transform><bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.7, 0.7"/></bsdf></shape>
)",
                       scale, turn, place);
  };
  return fmt::format(R"(<integrator type="path"><integer name="max_depth" value="{}"/>
<integer name="rr_depth" value="1000"/></integrator>
)",
                     max_depth) +
         sensor_element(size, size, "0, 0, 3.9", "0, 0, 0", 39.3) +
         wall("0.7, 0.7, 0.7", R"(<rotate x="1" angle="-90"/><translate y="-1"/>)") +
         wall("0.7, 0.7, 0.7", R"(<rotate x="1" angle="90"/><translate y="1"/>)") +
         wall("0.7, 0.7, 0.7", R"(<translate z="-1"/>)") +
         wall("0.1, 0.4, 0.1", R"(<rotate y="1" angle="-90"/><translate x="1"/>)") +
         wall("0.6, 0.1, 0.1", R"(<rotate y="1" angle="90"/><translate x="-1"/>)") +
         box(R"(value="0.3")", -17, R"(x="0.34" y="-0.7" z="0.38")") +
         box(R"(x="0.3" y="0.6" z="0.3")", 18, R"(x="-0.33" y="-0.4" z="-0.28")") +
         R"(<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/><scale value="0.25"/>
<translate y="0.99"/></transform><emitter type="area"><rgb name="radiance" value="18, 14, 7"/></emitter></shape>
)";
}

ImageMean image_mean(const FilmBuffer& film) {
  ImageMean mean;
  const double n = static_cast<double>(film.pixels());
  for (size_t i = 0; i < film.pixels(); ++i) {
    mean.value += film.mean(i) / n;
    mean.error += film.variance_of_mean(i) / (n * n);
  }
  mean.error = glm::sqrt(mean.error);
  return mean;
}

DeviceRender render_on_device(const Scene& scene, const RenderOptions& options, vulkan::Device& on) {
  const PackedScene packed = pack_scene(scene);
  Renderer renderer(on, packed, options);
  FilmBuffer film = renderer.render();
  return {std::move(film), renderer.statistics(), renderer.stages_run(), renderer.stages_skipped()};
}

void expect_agreement(const Scene& scene, const VerifyOptions& options) {
  expect_agreement(scene, scene, options);
}

void expect_agreement(const Scene& scene, const Scene& judged_by, const VerifyOptions& options,
                      RenderOptions render) {
  const PackedScene packed = pack_scene(scene);
  const auto on_device = [&](uint64_t samples, int round) -> std::optional<Image> {
    render.samples = samples;
    // Kernels know the bits of the last index: with the same end in all rounds they are the same kernels.
    render.first_sample = std::max(samples, kEndOfSamples) - samples;
    render.seed = static_cast<uint32_t>(round);
    Renderer renderer(device(), packed, render);
    const FilmBuffer film = renderer.render();
    EXPECT_EQ(renderer.statistics().nonfinite, 0u);
    EXPECT_EQ(renderer.statistics().overflow, 0u);
    return film.to_image();
  };
  const auto on_reference = [&](uint64_t samples, int round) -> std::optional<Image> {
    ReferenceOptions reference;
    reference.samples = samples;
    reference.seed = 1000 + static_cast<uint32_t>(round);
    const ReferenceImage image = render_reference(judged_by, reference);
    EXPECT_EQ(image.nonfinite, 0u);
    return to_image(image);
  };
  const Verification result = verify(on_device, on_reference, options);
  EXPECT_EQ(result.verdict, Verification::Verdict::kAgree)
      << result.samples << " samples\n" << describe(result.comparison);
}

}  // namespace tachylite::test
