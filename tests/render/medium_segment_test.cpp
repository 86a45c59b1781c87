// Light of point and spot lights scattered once along a ray, against quadrature; and the stage that samples it.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "shared/medium.h"
#include "support/render_test.h"

namespace tachylite::test {
namespace {

using MediumSegment = DeviceTest;
using glm::dvec3;

constexpr int kSize = 16;
const dvec3 kIntensity(12, 10, 8);

/// The camera at (0, 0, 4) looks at the origin through practically one ray; a null cube from z = -1 to 1 holds the
/// medium. The light is at `light`; a spot looks along -y.
struct Setting {
  const char* name;
  dvec3 sigma_t, albedo;
  double g;
  dvec3 light;
  bool spot = false;
};

std::string scene_text(const Setting& s, int max_depth) {
  const std::string position = fmt::format(R"(x="{}" y="{}" z="{}")", s.light.x, s.light.y, s.light.z);
  const std::string intensity = R"(<rgb name="intensity" value="12, 10, 8"/>)";
  const std::string light =
      s.spot ? fmt::format(R"(<emitter type="spot"><transform name="to_world"><rotate x="1" angle="90"/><translate {}/>
</transform><float name="cutoff_angle" value="30"/><float name="beam_width" value="20"/>{}</emitter>)",
                           position, intensity)
             : fmt::format(R"(<emitter type="point"><point name="position" {}/>{}</emitter>)", position, intensity);
  return fmt::format(R"(<integrator type="volpath"><integer name="max_depth" value="{}"/></integrator>)", max_depth) +
         sensor_element(kSize, kSize, "0, 0, 4", "0, 0, 0", 1e-3) + light +
         fmt::format(R"(<shape type="cube"><bsdf type="null"/><medium name="interior" type="homogeneous">
<rgb name="sigma_t" value="{}, {}, {}"/><rgb name="albedo" value="{}, {}, {}"/><float name="scale" value="10"/>
<phase type="hg"><float name="g" value="{}"/></phase></medium></shape>)",
                     s.sigma_t.x / 10, s.sigma_t.y / 10, s.sigma_t.z / 10, s.albedo.x, s.albedo.y, s.albedo.z, s.g);
}

/// Length within the cube of the way from a point inside to the light.
double length_inside(const dvec3& p, const dvec3& light) {
  const dvec3 to = light - p;
  double end = 1;
  for (int k = 0; k < 3; ++k)
    if (to[k] != 0) end = std::min(end, ((to[k] > 0 ? 1 : -1) - p[k]) / to[k]);
  return end * glm::length(to);
}

/// Radiance along the ray from z = 1 to -1 by Simpson's rule in the angle at the light.
dvec3 single_scattering(const Setting& s) {
  const double h = std::hypot(s.light.x, s.light.y), first = std::atan2(s.light.z - 1, h),
               last = std::atan2(s.light.z + 1, h);
  constexpr int kSteps = 20000;
  dvec3 sum(0);
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = first + (last - first) * i / kSteps, z = s.light.z - h * std::tan(angle), t = 1 - z;
    const dvec3 p(0, 0, z), to = s.light - p;
    const double r2 = glm::dot(to, to), c = -to.z / std::sqrt(r2);  // the ray goes along -z
    const double q = 1 + s.g * s.g - 2 * s.g * c;
    double weight = (i == 0 || i == kSteps ? 1 : i % 2 ? 4 : 2) * (last - first) / (3 * kSteps) / h;  // dz / r^2
    weight *= (1 - s.g * s.g) / (4 * std::numbers::pi * q * std::sqrt(q));
    if (s.spot) {
      const double off = std::acos(to.y / std::sqrt(r2)) * 180 / std::numbers::pi;
      weight *= std::clamp((30 - off) / 10, 0.0, 1.0);
    }
    for (int k = 0; k < 3; ++k)
      sum[k] += weight * s.albedo[k] * s.sigma_t[k] * kIntensity[k] *
                std::exp(-s.sigma_t[k] * (t + length_inside(p, s.light)));
  }
  return sum;
}

struct Estimate {
  dvec3 mean{0}, deviation{0};
};
Estimate estimate(const Setting& setting, uint64_t samples, int max_depth = 2) {
  RenderOptions options;
  options.samples = samples;
  const DeviceRender result = render_on_device(scene_from_elements(scene_text(setting, max_depth)), options);
  EXPECT_EQ(result.statistics.nonfinite + result.statistics.overflow, 0u);
  constexpr size_t kPixels = kSize * kSize;
  Estimate e;
  dvec3 squares(0);
  for (size_t i = 0; i < kPixels; ++i) {
    e.mean += result.film.mean(i) / double{kPixels};
    squares += result.film.mean(i) * result.film.mean(i) / double{kPixels};
  }
  e.deviation = glm::sqrt(glm::max(squares - e.mean * e.mean, dvec3(0)) / double{kPixels});
  return e;
}

TEST_F(MediumSegment, SingleScatteringOfPointAndSpotLights) {
  // 5 deviations: 6e-7 a channel; a bias of 1 % of thin media and of 3 % of dense ones is beyond 10 deviations.
  const std::vector<Setting> settings = {
      {"thin, light close to the ray", dvec3(0.05), dvec3(1), 0, {0.02, 0.01, 0.3}},
      {"thin, light outside", dvec3(0.05, 0.03, 0.01), dvec3(0.9, 0.8, 0.7), 0, {0, 2.5, 0}},
      {"coloured, forward", dvec3(5, 1, 0.2), dvec3(0.9, 0.8, 0.7), 0.7, {0.3, 0.2, -0.4}},
      {"dense", dvec3(9, 9, 9), dvec3(1), -0.5, {0.05, 0, 0.9}},
      {"light beyond the end", dvec3(1), dvec3(0.5), 0, {0.001, 0, -2}},
      {"one channel scatters", dvec3(1, 0, 0), dvec3(0.5), 0, {0.2, 0.2, 0}},
      {"spot", dvec3(0.4, 0.2, 0.1), dvec3(1), 0.3, {0.1, 1.5, 0.2}, true}};
  for (const Setting& s : settings) {
    const dvec3 expected = single_scattering(s);
    const Estimate e = estimate(s, 64);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(e.mean[c], expected[c], 5 * e.deviation[c] + 1e-4 * expected[c]) << s.name << " " << c;
      EXPECT_LE(e.deviation[c], 0.004 * expected[c]) << s.name << " " << c;
    }
  }
}

TEST_F(MediumSegment, LightOnTheRayIsFinite) {
  // The integral has no bound there: only that nothing is dropped and nothing is NaN.
  for (const double z : {0.5, 4.0, -1.0})
    for (const double x : {0.0, 1e-12}) {
      SCOPED_TRACE(fmt::format("x = {}, z = {}", x, z));
      const Estimate e = estimate({"on the ray", dvec3(1), dvec3(1), 0, {x, 0, z}}, 4);
      for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(e.mean[c]));
    }
}

TEST_F(MediumSegment, OnlyWhereItHelps) {
  const auto segments = [](const std::string& elements) {
    return (pack_scene(scene_from_elements(elements)).features.media & gpu::kMediaSegments) != 0;
  };
  const Setting thin{"thin", dvec3(0.05), dvec3(1), 0, {0, 2, 0}};
  EXPECT_TRUE(segments(scene_text(thin, 4)));
  std::string clear = scene_text(thin, 4);
  clear.replace(clear.find(R"(<float name="scale" value="10"/>)"), 32, R"(<float name="scale" value="0"/>)");
  EXPECT_FALSE(segments(clear));
  std::string sun = scene_text(thin, 4);
  const size_t begin = sun.find("<emitter"), end = sun.find("</emitter>") + 10;
  sun.replace(begin, end - begin, R"(<emitter type="directional"/>)");
  EXPECT_FALSE(segments(sun));

  RenderOptions options;
  options.samples = 4;
  const DeviceRender with = render_on_device(scene_from_elements(scene_text(thin, 4)), options);
  const DeviceRender without = render_on_device(scene_from_elements(sun), options);
  const auto has = [](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), "shade_segment") != names.end();
  };
  EXPECT_TRUE(has(with.stages_run));
  EXPECT_TRUE(has(without.stages_skipped));
}

}  // namespace
}  // namespace tachylite::test
