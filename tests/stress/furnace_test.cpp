// Things that absorb nothing under a sky of radiance 1 show radiance 1, whatever their parameters: materials and media
// at their extremes. And slabs that absorb, by Beer and Lambert.

#include <cmath>

#include <fmt/format.h>

#include "stress/stress_case.h"

namespace tachylite::test {
namespace {

constexpr int kSize = 24;

std::string furnace(const std::string& integrator, const std::string& things, double fov = 24, double radiance = 1) {
  return integrator + sensor_element(kSize, kSize, "0, 0, 5", "0, 0, 0", fov) + things +
         fmt::format(R"(<emitter type="constant"><float name="radiance" value="{}"/></emitter>)", radiance);
}
std::string path(int max_depth) {
  return fmt::format(R"(<integrator type="path"><integer name="max_depth" value="{}"/>
<integer name="rr_depth" value="100000"/></integrator>)", max_depth);
}
std::string volpath(int max_depth) {
  return fmt::format(R"(<integrator type="volpath"><integer name="max_depth" value="{}"/>
<integer name="rr_depth" value="100000"/></integrator>)", max_depth);
}
std::string ball(const std::string& bsdf) { return R"(<shape type="sphere">)" + bsdf + "</shape>"; }
std::string cube(const std::string& medium, double scale = 1) {
  return fmt::format(R"(<shape type="cube"><transform name="to_world"><scale value="{}"/></transform><bsdf type="null"/>{}</shape>
)", scale, medium);
}
std::string medium(double sigma_t, double albedo, const std::string& phase = "") {
  return fmt::format(R"(<medium name="interior" type="homogeneous"><float name="sigma_t" value="{}"/>
<float name="albedo" value="{}"/>{}</medium>)", sigma_t, albedo, phase);
}
std::string hg(double g) { return fmt::format(R"(<phase type="hg"><float name="g" value="{}"/></phase>)", g); }

using Furnace = DeviceTest;

TEST_F(Furnace, SmoothConductors) {
  // F = ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2) at normal incidence; 1 for eta = 0 or huge k, at all angles.
  for (const auto& [eta, k] : {std::pair(0.0, 1e-3), {1.5, 1e8}}) {
    const std::string bsdf = fmt::format(R"(<bsdf type="conductor"><float name="eta" value="{}"/><float name="k" value="{}"/></bsdf>)", eta, k);
    expect_stress(scene_from_elements(furnace(path(8), ball(bsdf))),
                  {.name = fmt::format("mirror, eta {} k {}", eta, k), .samples = 4, .bound = 5e-6, .error = worst_pixel(1)});
  }
  // k = 0 is glass seen from outside: at the centre of a sphere that fills little, F of normal incidence.
  for (const double eta : {1.5, 100.0}) {
    const std::string bsdf = fmt::format(R"(<bsdf type="conductor"><float name="eta" value="{}"/><float name="k" value="0"/></bsdf>)", eta);
    const double r = (eta - 1) / (eta + 1);
    expect_stress(scene_from_elements(furnace(path(8), ball(bsdf), 0.01)),
                  {.name = fmt::format("conductor with k = 0, eta {}, normal incidence", eta), .samples = 4, .bound = 1e-5,
                   .error = worst_pixel(r * r)});
  }
}

TEST_F(Furnace, SmoothDielectrics) {
  // What is reflected and what is refracted sum to 1; paths of 64 segments lose less than 1e-6.
  for (const double difference : {1e-7, -1e-7, 1e-4, -0.5, 3.0}) {
    const std::string bsdf = fmt::format(R"(<bsdf type="dielectric"><float name="int_ior" value="{:.9f}"/>
<float name="ext_ior" value="1"/></bsdf>)", 1 + difference);
    expect_stress(scene_from_elements(furnace(path(64), ball(bsdf))),
                  {.name = fmt::format("glass, eta 1 + {}", difference), .samples = 16, .bound = 2e-5,
                   .error = mean_beyond_noise(glm::dvec3(1))});
  }
}

TEST_F(Furnace, NearlySmoothRough) {
  // Single scattering loses O(alpha^2): below the bound here.
  for (const char* distribution : {"ggx", "beckmann"})
    for (const double alpha : {1e-6, 1e-3}) {
      const std::string rough = fmt::format(R"(<string name="distribution" value="{}"/><float name="alpha" value="{}"/>)", distribution, alpha);
      expect_stress(scene_from_elements(furnace(path(4), ball(R"(<bsdf type="roughconductor"><string name="material" value="none"/>)" + rough + "</bsdf>"), 18)),
                    {.name = fmt::format("rough mirror, {} {:.0e}", distribution, alpha), .samples = 16, .bound = 1e-3,
                     .error = mean_beyond_noise(glm::dvec3(1))});
      expect_stress(scene_from_elements(furnace(path(48), ball(R"(<bsdf type="roughdielectric">)" + rough + "</bsdf>"), 18)),
                    {.name = fmt::format("rough glass, {} {:.0e}", distribution, alpha), .samples = 16, .bound = 1e-3,
                     .error = mean_beyond_noise(glm::dvec3(1))});
    }
}

TEST_F(Furnace, MediaThatAbsorbNothing) {
  for (const auto& [g, depth] : {std::pair(0.9, 1e-7), {-0.99999, 1e-2}, {0.0, 5.0}, {0.99999, 30.0}, {-0.99999, 3.0}}) {
    expect_stress(scene_from_elements(furnace(volpath(-1), cube(medium(depth / 2, 1, hg(g))))),
                    {.name = fmt::format("white fog, optical depth {:.0e}, g {}", depth, g), .samples = 4, .bound = 1e-6,
                     .error = worst_pixel(1), .reference_error = mean_beyond_noise(glm::dvec3(1))});
  }
}

TEST_F(Furnace, ThousandEvents) {
  // Optical depth 60: 1,300 events a path in the mean. 4 x 4 pixels that see the middle.
  std::string scene = furnace(volpath(-1), cube(medium(30, 1)), 10);
  expect_stress(scene_from_elements(scene), {.name = "white fog, optical depth 60", .samples = 4, .bound = 1e-6,
                                             .error = worst_pixel(1),
                                             .reference_error = mean_beyond_noise(glm::dvec3(1))});
}

TEST_F(Furnace, MediaThatOnlyAbsorb) {
  for (const double depth : {1e-7, 1.0, 1e6}) {
    const double expected = std::exp(-depth);
    expect_stress(scene_from_elements(furnace(volpath(-1), cube(medium(depth / 2, 0)), 0.1)),
                  {.name = fmt::format("absorbing slab, optical depth {:.0e}", depth), .samples = 64,
                   .bound = depth > 1e5 ? 0 : 1e-5,
                   .error = depth > 1e5 ? std::function<double(const FilmBuffer&)>([](const FilmBuffer& film) {
                     return image_mean(film).value.x;
                   })
                                        : mean_beyond_noise(glm::dvec3(expected))});
  }
}

TEST_F(Furnace, SixteenNestedMedia) {
  std::string shells;
  for (int i = 0; i < 16; ++i) {
    std::string inside = medium(0.1 * (1 + i % 3), 1, hg(0.1 * (i % 9) - 0.4));
    // Each shell is outside the next one.
    if (i > 0) {
      std::string outside = medium(0.1 * (1 + (i - 1) % 3), 1, hg(0.1 * ((i - 1) % 9) - 0.4));
      outside.replace(outside.find("interior"), 8, "exterior");
      inside += outside;
    }
    shells += cube(inside, std::pow(0.9, i));
  }
  expect_stress(scene_from_elements(furnace(volpath(-1), shells)),
                {.name = "16 nested white media", .samples = 4, .bound = 1e-6, .error = worst_pixel(1),
                 .reference_error = mean_beyond_noise(glm::dvec3(1))});
}

TEST_F(Furnace, CameraOnTheBoundary) {
  // At z = 5 the camera lies in the plane of the cube's face.
  expect_stress(scene_from_elements(furnace(volpath(-1), cube(medium(0.3, 1), 5), 60)),
                {.name = "camera on the boundary of white fog", .samples = 4, .bound = 1e-6, .error = worst_pixel(1),
                 .reference_error = mean_beyond_noise(glm::dvec3(1))});
}

TEST_F(Furnace, TooManyNullSurfacesAreReported) {
  // 80 null planes between the light and what it lights: more than a shadow ray can pass.
  std::string scene = volpath(3) + sensor_element(8, 8, "0, 0, 0.5", "0, 0, 0", 30) +
                      R"(<shape type="rectangle"/><emitter type="point"><point name="position" x="0" y="0" z="9"/></emitter>)";
  for (int i = 0; i < 80; ++i)
    scene += fmt::format(R"(<shape type="rectangle"><transform name="to_world"><scale value="9"/><translate z="{}"/></transform>
<bsdf type="null"/></shape>)", 1 + 0.05 * i);
  RenderOptions options;
  options.samples = 4;
  EXPECT_GT(render_on_device(scene_from_elements(scene), options).statistics.overflow, 0u);
}

}  // namespace
}  // namespace tachylite::test
