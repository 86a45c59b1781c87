// A pixel's samples to the last that it can have, number 2^24 - 1: the last 4,096 are as good as the first, and others.

#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "reference/reference.h"
#include "stress/stress_case.h"

namespace tachylite::test {
namespace {

constexpr uint64_t kMostSamples = uint64_t{1} << 24, kSamples = 4096;

/// A diffuse floor under a square light of half width 1 at height 2, seen where the irradiance is that of four squares
/// with a corner above the point.
Scene lit_floor() {
  return scene_from_elements(R"(<integrator type="path"><integer name="max_depth" value="2"/></integrator>
<sensor type="perspective"><float name="fov" value="0.1"/><transform name="to_world">
<lookat origin="0, 0, 1" target="0, 0, 0" up="0, 1, 0"/></transform><film type="hdrfilm">
<integer name="width" value="4"/><integer name="height" value="4"/><rfilter type="box"/></film></sensor>
<shape type="rectangle"/><shape type="rectangle"><transform name="to_world"><rotate x="1" angle="180"/>
<translate z="2"/></transform><emitter type="area"/></shape>)");
}
/// 0.5 / pi times the irradiance.
double floor_radiance() {
  const double a = 1 / std::sqrt(5.0);  // of a square of side 1 and height 2, 2 a atan(a) / 2 a corner
  return 0.5 / M_PI * 4 * a * std::atan(a);
}

/// Root mean square of the pixels' errors over what it would be with independent samples.
double relative_error(const FilmBuffer& film) {
  double squares = 0, independent = 0;
  for (size_t i = 0; i < film.pixels(); ++i) {
    squares += std::pow(film.mean(i).x - floor_radiance(), 2);
    independent += film.variance_of_mean(i).x;
  }
  return std::sqrt(squares / independent);
}

using Render = std::function<FilmBuffer(uint64_t first_sample, uint64_t samples)>;

Render on_device(const Scene& scene, KernelStructure structure) {
  return [&scene, structure](uint64_t first_sample, uint64_t samples) {
    RenderOptions options;
    options.samples = samples;
    options.first_sample = first_sample;
    options.structure = structure;
    return render_on_device(scene, options).film;
  };
}
Render on_reference(const Scene& scene) {
  return [&scene](uint64_t first_sample, uint64_t samples) {
    ReferenceOptions options;
    options.samples = samples;
    options.first_sample = first_sample;
    return render_reference(scene, options).film;
  };
}

/// Indices that were rounded to 23 bits, or cut, would repeat samples.
void expect_good_samples(const char* by, const Render& render, double bound) {
  const FilmBuffer first = render(0, kSamples), last = render(kMostSamples - kSamples, kSamples);
  for (const FilmBuffer* film : {&first, &last}) EXPECT_LT(relative_error(*film), bound) << by;
  for (size_t i = 0; i < first.pixels(); ++i) EXPECT_NE(first.mean(i).x, last.mean(i).x) << by;
  fmt::print("stress | last 4,096 of 2^24 samples against independent ones | bound {} | {} {:.2f}\n", bound, by,
             relative_error(last));
}

using SampleRange = DeviceTest;

TEST_F(SampleRange, TheLastSamplesAreAsGoodAsTheFirst) {
  const Scene scene = lit_floor();
  // Each is a net in the pixel's and the light's dimensions: independent samples have 1 with a scatter of 0.18.
  expect_good_samples("stages", on_device(scene, KernelStructure::kStages), 0.3);
  expect_good_samples("one kernel", on_device(scene, KernelStructure::kFused), 0.3);
  // Those of the reference are independent: 16 squares of a mean of 1. 1.9 is exceeded with probability 1e-6.
  const Render reference = on_reference(scene);
  expect_good_samples("reference", reference, 1.9);
  const FilmBuffer last = reference(kMostSamples - 1, 1), before = reference(kMostSamples - 2, 1);
  for (size_t i = 0; i < last.pixels(); ++i) EXPECT_NE(last.mean(i).x, before.mean(i).x);
}

TEST_F(SampleRange, NoneBeyond) {
  const Scene scene = lit_floor();
  for (const Render& render : {on_device(scene, KernelStructure::kStages), on_reference(scene)}) {
    EXPECT_THROW(render(kMostSamples - kSamples, kSamples + 1), InputError);
    EXPECT_THROW(render(kMostSamples, 1), InputError);
  }
}

}  // namespace
}  // namespace tachylite::test
