// Media on the device: identities that hold bit for bit, and closed forms.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reference/reference.h"
#include "shared/medium.h"
#include "support/render_test.h"
#include "wavefront/scene_buffers.h"

namespace tachylite::test {
namespace {

using MediumRender = DeviceTest;

RenderOptions stages(uint64_t samples) {
  RenderOptions options;
  options.samples = samples;
  options.structure = KernelStructure::kStages;
  return options;
}

std::string integrator(const char* type, int max_depth = 16) {
  return fmt::format(R"(<integrator type="{}"><integer name="max_depth" value="{}"/>
<integer name="rr_depth" value="1000"/></integrator>)",
                     type, max_depth);
}

std::string medium(const std::string& sigma_t, const std::string& albedo, double scale, const std::string& phase = "",
                   const char* name = "interior") {
  return fmt::format(R"(<medium name="{}" type="homogeneous"><rgb name="sigma_t" value="{}"/>
<rgb name="albedo" value="{}"/><float name="scale" value="{}"/>{}</medium>)",
                     name, sigma_t, albedo, scale, phase);
}

/// A null cube of half the size `half` along z, with something inside.
std::string null_cube(const std::string& inside, double half = 1, double z = 0) {
  return fmt::format(R"(<shape type="cube"><transform name="to_world"><scale x="1" y="1" z="{}"/>
<translate z="{}"/></transform><bsdf type="null"/>{}</shape>)",
                     half, z, inside);
}

const std::string kSky = R"(<emitter type="constant"><rgb name="radiance" value="1, 1, 1"/></emitter>)";
const std::string kPoint = R"(<emitter type="point"><point name="position" x="2" y="3" z="2"/>
<rgb name="intensity" value="12, 10, 8"/></emitter>)";
const std::string kFloor =
    R"(<shape type="rectangle"><transform name="to_world"><scale value="3"/><rotate x="1" angle="-90"/>
<translate y="-1.2"/></transform></shape>)";

size_t different_pixels(const FilmBuffer& a, const FilmBuffer& b) {
  size_t different = 0;
  for (size_t i = 0; i < static_cast<size_t>(a.width() * a.height()); ++i) different += a.mean(i) != b.mean(i);
  return different;
}

FilmBuffer render(const std::string& elements, uint64_t samples = 16) {
  const DeviceRender result = render_on_device(scene_from_elements(elements), stages(samples));
  EXPECT_EQ(result.statistics.nonfinite, 0u);
  EXPECT_EQ(result.statistics.overflow, 0u);
  return result.film;
}

TEST_F(MediumRender, ZeroMediumIsNone) {
  const std::string common = integrator("volpath") + sensor_element(24, 24) + kFloor + kPoint + kSky;
  const FilmBuffer none = render(common + null_cube(""));
  EXPECT_EQ(different_pixels(none, render(common + null_cube(medium("0, 0, 0", "0.5, 0.5, 0.5", 1)))), 0u);
  EXPECT_EQ(different_pixels(none, render(common + null_cube(medium("1, 1, 1", "0.5, 0.5, 0.5", 0)))), 0u);
  EXPECT_GT(different_pixels(none, render(common + null_cube(medium("1, 1, 1", "0.5, 0.5, 0.5", 1)))), 100u);
}

TEST_F(MediumRender, IsotropicIsHenyeyGreensteinOfZero) {
  const std::string common = integrator("volpathmis") + sensor_element(24, 24) + kFloor + kPoint;
  const auto with_phase = [&](const std::string& phase) {
    return render(common + null_cube(medium("1, 0.5, 0.2", "0.9, 0.8, 0.7", 2, phase)));
  };
  const FilmBuffer isotropic = with_phase(R"(<phase type="isotropic"/>)");
  EXPECT_EQ(different_pixels(isotropic, with_phase(R"(<phase type="hg"><float name="g" value="0"/></phase>)")), 0u);
  EXPECT_GT(different_pixels(isotropic, with_phase(R"(<phase type="hg"><float name="g" value="0.5"/></phase>)")), 50u);
}

TEST_F(MediumRender, ScenesWithoutMediaPayNothing) {
  std::string cornell = cornell_elements(24);
  const DeviceRender path = render_on_device(scene_from_elements(cornell), stages(4));
  cornell.replace(cornell.find(R"("path")"), 6, R"("volpath")");
  const Scene scene = scene_from_elements(cornell);
  const DeviceRender volpath = render_on_device(scene, stages(4));
  EXPECT_EQ(different_pixels(path.film, volpath.film), 0u);
  EXPECT_EQ(path.stages_run, volpath.stages_run);
  EXPECT_EQ(pack_scene(scene).features.media, 0u);

  // Null surfaces alone bring the walk of shadow rays, but no medium.
  const DeviceRender null_only = render_on_device(
      scene_from_elements(integrator("volpath") + sensor_element(8, 8) + kFloor + kPoint + null_cube("")), stages(4));
  const auto has = [](const std::vector<std::string>& list, const char* name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  EXPECT_TRUE(has(null_only.stages_run, "intersect_shadow_transmittance"));
  EXPECT_TRUE(has(null_only.stages_skipped, "sample_medium"));
  EXPECT_TRUE(has(null_only.stages_skipped, "shade_medium"));
}

TEST_F(MediumRender, NullSurfacesAreInvisible) {
  // Not bit for bit: rays begin anew, with rounded origins.
  const std::string common = integrator("volpath", 4) + sensor_element(24, 24) + kFloor + kPoint + kSky;
  const FilmBuffer without = render(common), with = render(common + null_cube("") + null_cube("", 0.5));
  for (size_t i = 0; i < 24 * 24; ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(with.mean(i)[c], without.mean(i)[c], 1e-3 * (1 + without.mean(i)[c])) << i;
}

TEST_F(MediumRender, BeerLambertOfShadowRays) {
  // A wall behind the camera's target, lit through a slab of thickness 2; the camera stands between them.
  const auto wall_through = [&](const std::string& inside) {
    return render(integrator("volpath", 2) + sensor_element(8, 8, "0, 0, 2", "0, 0, 0", 20) +
                  R"(<shape type="rectangle"/><emitter type="directional"><vector name="direction" x="0" y="0" z="-1"/>
<rgb name="irradiance" value="1, 1, 1"/></emitter>)" + (inside.empty() ? "" : null_cube(inside, 1, 5)), 4);
  };
  const glm::dvec3 clear = wall_through("").mean(27);
  for (double tau : {1e-7, 1e-3, 0.1, 1.0, 10.0, 60.0, 1e6}) {
    const glm::dvec3 depth = tau * glm::dvec3(1, 0.5, 0.1);
    const glm::dvec3 seen = wall_through(medium("1, 0.5, 0.1", "0, 0, 0", tau / 2)).mean(27);
    for (int c = 0; c < 3; ++c) {
      const double expected = clear[c] * std::exp(-depth[c]);
      EXPECT_NEAR(seen[c], expected, 4e-6 * (1 + depth[c]) * expected + 1e-37) << tau << " " << c;
    }
  }
}

TEST_F(MediumRender, BeerLambertOfPaths) {
  // The sky through a slab of thickness 2, in 65536 samples; 5 deviations: 6e-7 a channel.
  for (double tau : {1e-3, 0.1, 1.0, 6.0, 1e6}) {
    const std::string colours = tau < 1e5 ? "1, 0.5, 0.2" : "1, 1, 1";
    const glm::dvec3 depth = tau * (tau < 1e5 ? glm::dvec3(1, 0.5, 0.2) : glm::dvec3(1));
    const ImageMean mean = image_mean(render(integrator("volpath") + sensor_element(32, 32, "0, 0, 400", "0, 0, 0", 0.1) +
                                         kSky + null_cube(medium(colours, "0, 0, 0", tau / 2)), 64));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(mean.value[c], std::exp(-depth[c]), 5 * mean.error[c] + 1e-6) << tau << " " << c;
  }
}

TEST_F(MediumRender, Furnace) {
  // Nothing is absorbed: grey media keep every path's throughput at exactly 1, coloured ones in the mean.
  const auto cube = [&](const std::string& colours, double scale, const std::string& phase) {
    return render(integrator("volpath", -1) + sensor_element(24, 24, "0, 0, 4", "0, 0, 0", 25) + kSky +
                      null_cube(medium(colours, "1, 1, 1", scale, phase)), 64);
  };
  const std::string forward = R"(<phase type="hg"><float name="g" value="0.8"/></phase>)";
  for (const std::string& phase : {std::string(), forward}) {
    const FilmBuffer grey = cube("1, 1, 1", 2, phase);
    for (size_t i = 0; i < 24 * 24; ++i) EXPECT_EQ(grey.mean(i), glm::dvec3(1)) << i;
    const ImageMean mean = image_mean(cube("1, 0.4, 0.1", 3, phase));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean.value[c], 1, 5 * mean.error[c] + 1e-6) << c;
    EXPECT_LT(mean.error.x, 0.01);
  }
}

TEST_F(MediumRender, IndexMatchedBoundaryIsNull) {
  // Below |eta - 1| = 1e-6 (float refraction could not tell it from 1) both renderers take the surface for null.
  const std::string common = integrator("volpath", 4) + sensor_element(24, 24) + kFloor + kPoint + kSky;
  const auto boundary = [&](const std::string& bsdf) {
    std::string cube = null_cube(medium("1, 0.5, 0.2", "0.9, 0.8, 0.7", 1));
    const std::string null = R"(<bsdf type="null"/>)";
    return common + cube.replace(cube.find(null), null.size(), bsdf);
  };
  const auto dielectric = [&](const char* outside) {
    return boundary(fmt::format(R"(<bsdf type="dielectric"><float name="int_ior" value="1.5"/>
<float name="ext_ior" value="{}"/></bsdf>)", outside));
  };
  const auto reference = [](const std::string& elements) {
    ReferenceOptions options;
    options.samples = 4;
    return render_reference(scene_from_elements(elements), options).film;
  };
  const std::string null = boundary(R"(<bsdf type="null"/>)");
  const FilmBuffer on_device = render(null), by_reference = reference(null);
  for (const char* matched : {"1.5", "1.5000005"}) {
    EXPECT_EQ(different_pixels(on_device, render(dielectric(matched))), 0u) << matched;
    EXPECT_EQ(different_pixels(by_reference, reference(dielectric(matched))), 0u) << matched;
  }
  EXPECT_GT(different_pixels(on_device, render(dielectric("1.501"))), 100u);
  EXPECT_GT(different_pixels(by_reference, reference(dielectric("1.501"))), 100u);
}

TEST_F(MediumRender, OrderOfSiblingsDoesNotMatter) {
  const std::string common = integrator("volpath", 6) + sensor_element(24, 24);
  const std::string ball = R"(<shape type="sphere"><float name="radius" value="0.5"/><bsdf type="null"/>)" +
                           medium("0.2, 0.5, 1", "0.9, 0.8, 0.7", 4) + medium("1, 0.5, 0.2", "0.9, 0.8, 0.7", 1, "", "exterior") +
                           "</shape>";
  const std::string cube = null_cube(medium("1, 0.5, 0.2", "0.9, 0.8, 0.7", 1));
  EXPECT_EQ(different_pixels(render(common + kFloor + cube + ball + kPoint), render(common + kPoint + ball + cube + kFloor)),
            0u);
}

TEST_F(MediumRender, SplitByANullPlane) {
  const std::string common = integrator("volpathmis", 32) + sensor_element(24, 24) + kFloor + kPoint;
  const std::string fog = medium("1, 0.6, 0.3", "0.9, 0.8, 0.7", 1.5);
  const ImageMean whole = image_mean(render(common + null_cube(fog), 64));
  std::string plane = R"(<shape type="rectangle"><bsdf type="null"/>)" + fog + fog;
  plane.replace(plane.rfind("interior"), 8, "exterior");
  const ImageMean split = image_mean(render(common + null_cube(fog) + plane + "</shape>", 64));
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(whole.value[c], split.value[c], 5 * std::hypot(whole.error[c], split.error[c])) << c;
}

}  // namespace
}  // namespace tachylite::test
