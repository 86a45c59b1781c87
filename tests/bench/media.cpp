#include "bench/media.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "base/timer.h"
#include "shared/medium.h"
#include "support/render_test.h"

namespace tachylite::bench {
namespace {

using test::scene_from_elements;
using test::sensor_element;

std::string integrator(int max_depth) {
  return fmt::format(R"(<integrator type="volpath"><integer name="max_depth" value="{}"/>
<integer name="rr_depth" value="100000"/></integrator>)",
                     max_depth);
}

/// The camera in fog, 5 before a point light that is 0.3 beside the axis and 1 above a floor.
std::string fog(double sigma_t, int max_depth) {
  std::string sensor = sensor_element(32, 32, "0, 0.3, 5", "0, 0.3, 0", 40);
  sensor.insert(sensor.find("</sensor>"), R"(<ref id="fog"/>)");
  return fmt::format(R"(<medium id="fog" type="homogeneous"><float name="sigma_t" value="{}"/>
<float name="albedo" value="0.9"/></medium>)",
                     sigma_t) +
         integrator(max_depth) + sensor + R"(<shape type="rectangle"><transform name="to_world"><scale value="20"/>
<rotate x="1" angle="-90"/><translate y="-1"/></transform></shape>
<shape type="rectangle"><transform name="to_world"><scale value="20"/><translate z="-5"/></transform></shape>
<emitter type="point"><point name="position" x="0.3" y="0" z="0"/><rgb name="intensity" value="1, 1, 1"/></emitter>)";
}

/// A null ball of radius 1 under a white sky.
std::string ball(const char* sigma_t) {
  return integrator(-1) + sensor_element(24, 24, "0, 0, 4", "0, 0, 0", 28) +
         R"(<emitter type="constant"/><shape type="sphere"><bsdf type="null"/><medium name="interior" type="homogeneous">)" +
         fmt::format(R"(<rgb name="sigma_t" value="{}"/><float name="albedo" value="0.9"/><float name="scale" value="10"/>)",
                     sigma_t) +
         "</medium></shape>";
}

/// A column of smoke in a null cube: 48^3 voxels, a tenth of them not empty, a few of them dense.
Scene smoke() {
  Scene scene = scene_from_elements(
      integrator(6) + sensor_element(24, 24, "0, 0, 4", "0, 0, 0", 35) + R"(<emitter type="constant"/>
<emitter type="point"><point name="position" x="2" y="2" z="2"/><rgb name="intensity" value="20, 20, 20"/></emitter>
<shape type="cube"><bsdf type="null"/><medium name="interior" type="homogeneous"/></shape>)");
  auto grid = std::make_shared<Grid>();
  constexpr int kVoxels = 48;
  grid->nx = grid->ny = grid->nz = kVoxels;
  grid->channels = 1;
  for (int z = 0; z < kVoxels; ++z)
    for (int y = 0; y < kVoxels; ++y)
      for (int x = 0; x < kVoxels; ++x) {
        const double height = y / double{kVoxels}, turn = 9 * height;
        const double off = std::hypot(x - 24 - 8 * std::sin(turn), z - 24 - 8 * std::cos(turn)) / (3 + 6 * height);
        grid->values.push_back(static_cast<float>(off < 1 ? (off < 0.3 ? 8 : 1) * (1 - off) : 0));
      }
  HeterogeneousMedium medium;
  medium.scale = 20;
  medium.albedo.constant = dvec3(0.9);
  medium.sigma_t.grid = grid;
  medium.sigma_t.to_world = dmat4(2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, -1, -1, -1, 1);
  scene.media[0].kind = medium;
  return scene;
}

/// One majorant for the whole grid of the scene's first medium.
void merge_majorants(PackedScene& scene) {
  glm::vec4& row = scene.media[1];
  const uint32_t first = std::bit_cast<uint32_t>(row.x), n = std::bit_cast<uint32_t>(row.y);
  const uint32_t count = (n & 0xffu) * (n >> 8 & 0xffu) * (n >> 16);
  scene.grids[first] = *std::max_element(scene.grids.begin() + first, scene.grids.begin() + first + count);
  row.y = std::bit_cast<float>(1u | 1u << 8 | 1u << 16);
}

struct Replicates {
  std::vector<glm::dvec3> sum, squares;
  double largest = 0, seconds = 0;
  int count = 0;

  void add(const FilmBuffer& film) {
    const auto pixels = static_cast<size_t>(film.width() * film.height());
    sum.resize(pixels);
    squares.resize(pixels);
    double mean = 0, most = 0;
    for (size_t i = 0; i < pixels; ++i) {
      const glm::dvec3 value = film.mean(i);
      sum[i] += value;
      squares[i] += value * value;
      mean += (value.x + value.y + value.z) / (3.0 * static_cast<double>(pixels));
      most = std::max({most, value.x, value.y, value.z});
    }
    largest = std::max(largest, most / mean);
    ++count;
  }
  double mean() const {
    double result = 0;
    for (const glm::dvec3& s : sum) result += (s.x + s.y + s.z) / (3.0 * count * static_cast<double>(sum.size()));
    return result;
  }
  double relative_mse() const {
    const double floor = 1e-3 * mean() * mean();
    double result = 0;
    for (size_t i = 0; i < sum.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double m = sum[i][c] / count, variance = (squares[i][c] - count * m * m) / (count - 1);
        result += variance / (m * m + floor) / (3.0 * static_cast<double>(sum.size()));
      }
    return result;
  }
};

MediumGain compare(const std::string& name, const Scene& scene, uint64_t samples, int replicates,
                   const std::function<void(PackedScene&)>& make_yardstick) {
  const PackedScene ours = pack_scene(scene);
  PackedScene yardstick = pack_scene(scene);
  make_yardstick(yardstick);
  vulkan::Device device;
  const auto render = [&](const PackedScene& packed, int seed, Replicates& into) {
    RenderOptions options;
    options.samples = samples;
    options.seed = static_cast<uint32_t>(seed);
    options.structure = KernelStructure::kStages;
    Renderer renderer(device, packed, options);
    CpuTimer timer;
    into.add(renderer.render());
    into.seconds += timer.seconds();
  };
  Replicates a, b;
  for (int r = 0; r < replicates; ++r) {
    render(ours, r, a);
    render(yardstick, r, b);
  }
  return {name, a.relative_mse(), b.relative_mse(), a.largest, b.largest, a.mean() / b.mean(), a.seconds / b.seconds};
}

}  // namespace

std::vector<MediumGain> bench_medium_gains(int replicates) {
  const auto at_collisions = [](PackedScene& scene) { scene.features.media &= ~gpu::kMediaSegments; };
  const auto uniform = [](PackedScene& scene) { scene.features.media |= gpu::kMediaUniformChannel; };
  return {compare("fog, sigma_t 0.02, single scattering", scene_from_elements(fog(0.02, 2)), 64, replicates, at_collisions),
          compare("fog, sigma_t 0.02, depth 6", scene_from_elements(fog(0.02, 6)), 64, replicates, at_collisions),
          compare("fog, sigma_t 0.3, depth 6", scene_from_elements(fog(0.3, 6)), 64, replicates, at_collisions),
          compare("smoke, 16^3 majorants against one", smoke(), 16, replicates, merge_majorants),
          compare("ball, sigma_t 1, 2.5, 6", scene_from_elements(ball("0.1, 0.25, 0.6")), 64, replicates, uniform),
          compare("ball, sigma_t 0.2, 1, 5", scene_from_elements(ball("0.02, 0.1, 0.5")), 64, replicates, uniform)};
}

std::vector<MediumCost> bench_medium_costs() {
  // A medium without end: each ray collides.
  std::string sensor = sensor_element(64, 64);
  sensor.insert(sensor.find("</sensor>"), R"(<ref id="fog"/>)");
  const PackedScene packed = pack_scene(scene_from_elements(
      R"(<medium id="fog" type="homogeneous"><rgb name="sigma_t" value="1, 0.9, 0.8"/><float name="albedo" value="1"/>
<phase type="hg"><float name="g" value="0.5"/></phase></medium>)" +
      integrator(18) + sensor +
      R"(<shape type="rectangle"><transform name="to_world"><translate z="-1000"/></transform></shape>
<emitter type="point"><point name="position" x="0" y="1" z="0"/></emitter>)"));
  vulkan::Device device;
  RenderOptions options;
  options.samples = 32;
  options.timing = true;
  options.structure = KernelStructure::kStages;
  Renderer renderer(device, packed, options);
  renderer.render();
  const double events = static_cast<double>(renderer.statistics().closest_rays);
  std::vector<MediumCost> costs;
  for (const auto& [kernel, time] : renderer.statistics().kernels) costs.push_back({kernel, 1e9 * time.seconds / events});
  return costs;
}

}  // namespace tachylite::bench
