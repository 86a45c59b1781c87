// Images that follow from each other bit for bit. Multiplying by powers of two is exact, so that a scene whose radiance
// or whose lengths are scaled has the same image, scaled: any absolute epsilon, clamp or underflow shows.

#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "stress/stress_case.h"

namespace tachylite::test {
namespace {

// A box with mesh, sphere, rough metal and glass in it; sunlit through an environment as well.
const std::string kThings = R"(<shape type="sphere"><point name="center" x="0.3" y="-0.5" z="0.2"/>
<float name="radius" value="0.5"/><bsdf type="roughconductor"><float name="alpha" value="0.2"/></bsdf></shape>
<shape type="sphere"><point name="center" x="-0.5" y="-0.6" z="0.4"/><float name="radius" value="0.4"/>
<bsdf type="dielectric"/></shape>)";

void scale_radiance(Scene& scene, double factor) {
  for (Emitter& emitter : scene.emitters) {
    if (auto* area = std::get_if<AreaEmitter>(&emitter.kind)) area->radiance.value *= factor;
    if (auto* constant = std::get_if<ConstantEmitter>(&emitter.kind)) constant->radiance *= factor;
  }
}

void scale_lengths(Scene& scene, double factor) {
  const dmat4 scale = glm::scale(dmat4(1), dvec3(factor));
  for (Shape& shape : scene.shapes) shape.to_world = scale * shape.to_world;
  Sensor& sensor = scene.sensors[0];
  sensor.to_world[3] = glm::dvec4(dvec3(sensor.to_world[3]) * factor, 1);
  sensor.near_clip *= factor;
  sensor.far_clip *= factor;
}

std::vector<dvec3> means(const FilmBuffer& film) {
  std::vector<dvec3> values;
  for (size_t i = 0; i < film.pixels(); ++i) values.push_back(film.mean(i));
  return values;
}

// The largest difference of a pixel from factor * original, relative to it.
std::function<double(const FilmBuffer&)> against(std::vector<dvec3> original, double factor) {
  return [original = std::move(original), factor](const FilmBuffer& film) {
    double worst = 0;
    for (size_t i = 0; i < film.pixels(); ++i)
      for (int c = 0; c < 3; ++c)
        if (film.mean(i)[c] != factor * original[i][c])
          worst = std::max(worst, std::abs(film.mean(i)[c] - factor * original[i][c]) /
                                      std::max(factor * original[i][c], factor * 1e-3));
    return worst;
  };
}

using Scaling = DeviceTest;

TEST_F(Scaling, RadianceByPowersOfTwo) {
  for (const bool fits_one_kernel : {true, false}) {
    const Scene scene =
        scene_from_elements(cornell_elements(24) + (fits_one_kernel ? "" : kThings) + R"(<emitter type="constant"/>)");
    RenderOptions options;
    options.samples = 8;
    const std::vector<dvec3> original = means(render_on_device(scene, options).film);
    for (const int exponent : {-66, 66}) {  // 1e-20 ... 7e19
      const double factor = std::ldexp(1.0, exponent);
      Scene scaled = scene;
      scale_radiance(scaled, factor);
      const std::string name = fmt::format("radiance of {} by 2^{}", fits_one_kernel ? "a box" : "metal and glass", exponent);
      // Stages and one kernel add a path's contributions in different orders.
      expect_stress(scaled, {.name = name, .samples = 8, .bound = 2e-6, .error = against(original, factor), .on_reference = false,
                             .both_structures = true});
    }
  }
}

TEST_F(Scaling, LengthsByPowersOfTwo) {
  const Scene scene = scene_from_elements(cornell_elements(24) + kThings);
  RenderOptions options;
  options.samples = 8;
  const std::vector<dvec3> original = means(render_on_device(scene, options).film);
  for (const int exponent : {-14, 20}) {  // 6e-5 ... 1e6
    Scene scaled = scene;
    scale_lengths(scaled, std::ldexp(1.0, exponent));
    expect_stress(scaled, {.name = fmt::format("lengths by 2^{}", exponent), .samples = 8, .bound = 0,
                           .error = against(original, 1), .on_reference = false});
  }
}

}  // namespace
}  // namespace tachylite::test
