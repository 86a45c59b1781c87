// Many lights: the irradiance below them is the sum of Lambert's formula over all of them. TACHYLITE_LIGHTS: how many
// instead; a million take 11 to 13 CPU seconds and 1 GB.

#include <array>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "stress/stress_case.h"
#include "support/pcg32.h"

namespace tachylite::test {
namespace {

constexpr int kPowers = 8;   // meshes, of radiances from 1e-3 to 1e3
constexpr double kHalf = 5;  // half width of the ceiling, at height 1

using Corners = std::array<glm::dvec3, 3>;

/// Lambert's formula for a triangle of radiance 1 above the horizon of the origin, whose normal is z.
double irradiance(const Corners& corners) {
  double sum = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = corners[i], b = corners[(i + 1) % corners.size()], c = glm::cross(a, b);
    sum += std::atan2(glm::length(c), glm::dot(a, b)) * c.z / glm::length(c);
  }
  return 0.5 * std::abs(sum);
}

struct Ceiling {
  Scene scene;
  double irradiance = 0;  // at the origin

  explicit Ceiling(int side) {
    scene = scene_from_elements(R"(<integrator type="path"><integer name="max_depth" value="2"/></integrator>
<sensor type="perspective"><float name="fov" value="0.1"/><transform name="to_world">
<lookat origin="0, 0, 0.5" target="0, 0, 0" up="0, 1, 0"/></transform><film type="hdrfilm">
<integer name="width" value="8"/><integer name="height" value="8"/><rfilter type="box"/></film></sensor>
<shape type="rectangle"/>)");
    scene.bsdfs.push_back({{}, "", "diffuse", DiffuseBsdf{0.0}});
    std::vector<std::shared_ptr<Mesh>> meshes(kPowers);
    for (auto& mesh : meshes) mesh = std::make_shared<Mesh>();
    Pcg32 random(3);
    const double cell_size = 2 * kHalf / side;
    for (int i = 0; i < side * side; ++i) {
      // No two triangles touch, or they would be one rectangle.
      const glm::dvec3 cell(cell_size * (i % side) - kHalf, cell_size * (i / side) - kHalf, 1);
      const double size = cell_size * random.uniform(0.2f, 0.9f);
      const size_t power = random.below(kPowers);
      Mesh& mesh = *meshes[power];
      const auto first = static_cast<uint32_t>(mesh.positions.size());
      Corners corners;
      for (size_t k = 0; k < 3; ++k) {
        mesh.positions.emplace_back(cell + size * glm::dvec3(k == 2, k == 1, 0));  // faces down
        corners[k] = glm::dvec3(mesh.positions.back());
      }
      mesh.triangles.emplace_back(first, first + 1, first + 2);
      irradiance += radiance(power) * test::irradiance(corners);
    }
    for (size_t power = 0; power < kPowers; ++power) {
      Shape shape;
      shape.kind = MeshShape{meshes[power]};
      shape.bsdf = static_cast<BsdfIndex>(scene.bsdfs.size()) - 1;
      shape.emitter = static_cast<EmitterIndex>(scene.emitters.size());
      scene.emitters.push_back({{}, "area", AreaEmitter{radiance(power)}, static_cast<int>(scene.shapes.size())});
      scene.shapes.push_back(std::move(shape));
    }
  }

  static double radiance(size_t power) { return std::pow(10.0, 6.0 * static_cast<double>(power) / (kPowers - 1) - 3); }
};

using ManyLights = DeviceTest;

TEST_F(ManyLights, AddUp) {
  const char* wanted = std::getenv("TACHYLITE_LIGHTS");
  const int side = static_cast<int>(std::lround(std::sqrt(wanted ? std::atof(wanted) : 1e5)));
  const Ceiling ceiling(side);
  const double expected = 0.5 / M_PI * ceiling.irradiance;
  const auto error = [&](const FilmBuffer& film) {
    EXPECT_LT(image_mean(film).error.x, 0.01 * expected);  // or it would see nothing
    return mean_beyond_noise(glm::dvec3(expected))(film);
  };
  expect_stress(ceiling.scene, {.name = fmt::format("{} lights, radiances from 1e-3 to 1e3", side * side),
                                .samples = 4096, .bound = 1e-5, .error = error});
}

}  // namespace
}  // namespace tachylite::test
