#include "stress/stress_case.h"

#include <cmath>

#include <fmt/format.h>

#include "pack/bake_geometry.h"
#include "reference/reference.h"

namespace tachylite::test {

void expect_stress(const Scene& scene, const StressCase& c) {
  std::string line = fmt::format("stress | {} | bound {:.1e}", c.name, c.bound);
  const auto judge = [&](const char* by, const FilmBuffer& film, const std::function<double(const FilmBuffer&)>& measure) {
    const double error = measure(film);
    line += fmt::format(" | {} {:.1e}", by, error);
    EXPECT_LE(error, c.bound) << c.name << ", " << by;
  };
  const PackedScene packed = pack_scene(scene);
  const bool fits_one_kernel = bake_geometry(packed).has_value();
  for (const bool stages : {true, false}) {
    if (stages ? fits_one_kernel && !c.both_structures : !fits_one_kernel) continue;
    RenderOptions options;
    options.samples = c.samples;
    options.structure = stages ? KernelStructure::kStages : KernelStructure::kFused;
    Renderer renderer(device(), packed, options);
    judge(stages ? "stages" : "one kernel", renderer.render(), c.error);
    EXPECT_EQ(renderer.statistics().nonfinite, 0u) << c.name;
    EXPECT_EQ(renderer.statistics().overflow, 0u) << c.name;
  }
  if (c.on_reference) {
    ReferenceOptions options;
    options.samples = c.samples;
    const ReferenceImage image = render_reference(scene, options);
    judge("reference", image.film, c.reference_error ? c.reference_error : c.error);
    EXPECT_EQ(image.nonfinite, 0u) << c.name;
  }
  fmt::print("{}\n", line);
}

std::function<double(const FilmBuffer&)> worst_pixel(double expected) {
  return [expected](const FilmBuffer& film) {
    double worst = 0;
    for (size_t i = 0; i < film.pixels(); ++i)
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(film.mean(i)[c] / expected - 1));
    return worst;
  };
}

std::function<double(const FilmBuffer&)> mean_beyond_noise(const glm::dvec3& expected) {
  return [expected](const FilmBuffer& film) {
    const ImageMean mean = image_mean(film);
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
      const double beyond = std::abs(mean.value[c] - expected[c]) - 5 * mean.error[c];
      worst = std::max(worst, std::max(beyond, 0.0) / expected[c]);
    }
    return worst;
  };
}

}  // namespace tachylite::test
