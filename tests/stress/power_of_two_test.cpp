// A scene scaled by a power of two: every length is the same float32 with another exponent, so the image has the same
// bits.

#include <cmath>

#include <fmt/format.h>

#include "stress/stress_case.h"

namespace tachylite::test {
namespace {

using PowerOfTwo = DeviceTest;

TEST_F(PowerOfTwo, ScalesToTheSameBits) {
  constexpr int kSize = 16;
  const Scene scene = scene_from_elements(cornell_elements(kSize, 5));
  for (const KernelStructure structure : {KernelStructure::kStages, KernelStructure::kFused}) {
    RenderOptions options;
    options.samples = 4;
    options.structure = structure;
    const FilmBuffer unscaled = render_on_device(scene, options).film;
    for (const int exponent : {-10, 16}) {
      if (exponent < 0 && structure == KernelStructure::kFused) continue;  // its kernel is compiled anew for each scale
      const double scale = std::ldexp(1.0, exponent);
      Scene scaled = scene;
      for (Shape& shape : scaled.shapes)
        for (int column = 0; column < 4; ++column) shape.to_world[column] *= glm::dvec4(glm::dvec3(scale), 1);
      Sensor& sensor = scaled.sensors[0];
      sensor.to_world[3] *= glm::dvec4(glm::dvec3(scale), 1);
      sensor.near_clip *= scale;
      sensor.far_clip *= scale;
      const FilmBuffer film = render_on_device(scaled, options).film;
      int different = 0;
      double worst = 0;
      for (size_t i = 0; i < film.pixels(); ++i) {
        different += film.mean(i) != unscaled.mean(i);
        worst = std::max(worst, glm::length(film.mean(i) - unscaled.mean(i)) / glm::length(unscaled.mean(i)));
      }
      fmt::print("stress | Cornell box times 2^{} | {} | {} pixels differ, by {:.1e}\n", exponent,
                 structure == KernelStructure::kFused ? "one kernel" : "stages", different, worst);
      EXPECT_EQ(different, 0) << exponent;
    }
  }
}

}  // namespace
}  // namespace tachylite::test
