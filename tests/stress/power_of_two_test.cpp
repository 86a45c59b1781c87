// A scene scaled by a power of two: every length is the same number with another exponent, so the image has the same
// bits, on the device and by the reference.

#include <cmath>

#include <fmt/format.h>

#include "reference/reference.h"
#include "stress/stress_case.h"

namespace tachylite::test {
namespace {

Scene scaled(Scene scene, double scale) {
  for (Shape& shape : scene.shapes)
    for (int column = 0; column < 4; ++column) shape.to_world[column] *= glm::dvec4(glm::dvec3(scale), 1);
  Sensor& sensor = scene.sensors[0];
  sensor.to_world[3] *= glm::dvec4(glm::dvec3(scale), 1);
  sensor.near_clip *= scale;
  sensor.far_clip *= scale;
  return scene;
}

void expect_same_bits(const char* by, const Scene& scene, const std::vector<int>& exponents,
                      const std::function<FilmBuffer(const Scene&)>& render) {
  const FilmBuffer unscaled = render(scene);
  for (const int exponent : exponents) {
    const FilmBuffer film = render(scaled(scene, std::ldexp(1.0, exponent)));
    int different = 0;
    double worst = 0;
    for (size_t i = 0; i < film.pixels(); ++i) {
      different += film.mean(i) != unscaled.mean(i);
      worst = std::max(worst, glm::length(film.mean(i) - unscaled.mean(i)) / glm::length(unscaled.mean(i)));
    }
    fmt::print("stress | Cornell box times 2^{} | {} | {} pixels differ, by {:.1e}\n", exponent, by, different, worst);
    EXPECT_EQ(different, 0) << by << " " << exponent;
  }
}

using PowerOfTwo = DeviceTest;

TEST_F(PowerOfTwo, ScalesToTheSameBits) {
  constexpr uint64_t kSamples = 4;
  const Scene scene = scene_from_elements(cornell_elements(16, 5));
  const auto on_device = [](KernelStructure structure) {
    return [structure](const Scene& s) {
      RenderOptions options;
      options.samples = kSamples;
      options.structure = structure;
      return render_on_device(s, options).film;
    };
  };
  expect_same_bits("stages", scene, {-10, 16}, on_device(KernelStructure::kStages));
  expect_same_bits("one kernel", scene, {16}, on_device(KernelStructure::kFused));  // compiled anew for each scale
  expect_same_bits("reference", scene, {-10, 16}, [](const Scene& s) {
    ReferenceOptions options;
    options.samples = kSamples;
    return render_reference(s, options).film;
  });
}

}  // namespace
}  // namespace tachylite::test
