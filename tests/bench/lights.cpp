#include "bench/lights.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "base/timer.h"
#include "shared/light.h"
#include "support/pcg32.h"
#include "wavefront/renderer.h"

namespace tachylite::bench {
namespace {

constexpr int kSize = 64;
constexpr int kPowers = 16;           // meshes, of radiances from 1e-2 to 1e2
constexpr float kField = 50, kSeen = 4;  // half widths of the field and of what the camera sees

Sensor look_down(double height, double half_width) {
  Sensor sensor;
  sensor.to_world = glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, 1, 0), glm::dvec4(0, -1, 0, 0),
                               glm::dvec4(0, height, 0, 1));
  sensor.x_fov = 2 * std::atan(half_width / height);
  sensor.film.width = sensor.film.crop_width = sensor.film.height = sensor.film.crop_height = kSize;
  sensor.film.filter = ReconstructionFilter::kBox;
  sensor.film.filter_radius = 0.5;
  return sensor;
}

int add_shape(Scene& scene, decltype(Shape::kind) kind, const glm::dmat4& to_world, double reflectance) {
  scene.bsdfs.push_back({{}, "", "diffuse", DiffuseBsdf{reflectance}});
  Shape shape;
  shape.kind = std::move(kind);
  shape.to_world = to_world;
  shape.bsdf = static_cast<BsdfIndex>(scene.bsdfs.size()) - 1;
  scene.shapes.push_back(std::move(shape));
  return static_cast<int>(scene.shapes.size()) - 1;
}

Scene direct_light_scene() {
  Scene scene;
  scene.integrator.max_depth = 2;
  scene.integrator.rr_depth = 1000;
  add_shape(scene, RectangleShape{}, glm::rotate(glm::dmat4(1), glm::radians(-90.0), glm::dvec3(1, 0, 0)) *
                                         glm::scale(glm::dmat4(1), glm::dvec3(2.0 * kField)), 0.5);
  return scene;
}

/// `count` small triangles above a floor, the first above what the camera sees. `shining`: how many of them are lights.
Scene field_of_lights(uint32_t count, uint32_t shining) {
  Scene scene = direct_light_scene();
  scene.sensors.push_back(look_down(20, kSeen));
  std::vector<std::shared_ptr<Mesh>> meshes(2 * kPowers);  // those that shine, and those that do not
  for (auto& mesh : meshes) mesh = std::make_shared<Mesh>();
  test::Pcg32 random(7);
  for (uint32_t i = 0; i < count; ++i) {
    const float reach = i == 0 ? kSeen : kField;
    const glm::vec3 place = random.in_box({-reach, 0.5f, -reach}, {reach, 3, reach});
    const float size = 0.02f * (0.2f + random.uniform(0, 1));
    const auto power = static_cast<size_t>(random.uniform(0, kPowers - 0.001f)) + (i < shining ? 0 : kPowers);
    Mesh& mesh = *meshes[power];
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    const glm::vec3 tilt = random.in_box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}) * size;
    mesh.positions.insert(mesh.positions.end(), {place, place + glm::vec3(size, tilt.x, tilt.y), place + glm::vec3(tilt.z, 0, size)});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  for (size_t k = 0; k < meshes.size(); ++k) {
    if (meshes[k]->triangles.empty()) continue;
    const int shape = add_shape(scene, MeshShape{meshes[k]}, glm::dmat4(1), 0);
    if (k >= kPowers) continue;
    scene.shapes.back().emitter = static_cast<EmitterIndex>(scene.emitters.size());
    const double radiance = 1e4 * std::pow(10.0, 4.0 * static_cast<double>(k) / (kPowers - 1) - 2);
    scene.emitters.push_back({{}, "area", AreaEmitter{glm::dvec3(radiance)}, shape});
  }
  return scene;
}

/// Turns importances into counts: each light is chosen as often as any other. Bounds without a radius count as power.
void choose_uniformly(PackedScene& packed) {
  if (packed.features.selection == gpu::kSelectSingle) return;
  auto& table = packed.light_table;
  const auto row = [&](uint32_t child) -> glm::uvec4* {
    return &table[gpu::kLightTableHeaderRows + gpu::kLightNodeRows * child];
  };
  const auto count_below = [&](const auto& self, uint32_t child) -> float {
    const uint32_t word = row(child)[2].w;
    float count = 1;
    if (word & gpu::kLightNode) {
      count = 0;
      const uint32_t children = (word >> gpu::kLightNodeCountShift & (gpu::kLightNodeWidth - 1)) + 1;
      for (uint32_t i = 0; i < children; ++i) count += self(self, (word & gpu::kLightNodeFirstMask) + i);
    }
    row(child)[0].w = std::bit_cast<uint32_t>(-1.0f);
    row(child)[1].w = std::bit_cast<uint32_t>(count);
    return count;
  };
  for (uint32_t unit = 0; unit < table[0].x; ++unit) count_below(count_below, unit);
}

struct Measured {
  double ns_per_path = 0, relative_variance = 0;
};
/// The variance is that between the renders: no image need be known.
Measured measure(vulkan::Device& device, const PackedScene& packed, uint64_t samples, int repetitions) {
  Measured m;
  m.ns_per_path = std::numeric_limits<double>::infinity();
  RenderOptions options;
  options.samples = samples;
  options.sampler = SamplerKind::kIndependent;
  options.structure = KernelStructure::kStages;
  std::vector<double> sum(kSize * kSize), squares(kSize * kSize);
  const int renders = std::max(2, repetitions);
  for (int i = 0; i < renders; ++i) {
    options.seed = static_cast<uint32_t>(i);
    Renderer renderer(device, packed, options);
    CpuTimer timer;
    const FilmBuffer film = renderer.render();
    m.ns_per_path = std::min(m.ns_per_path, 1e9 * timer.seconds() / (kSize * kSize * static_cast<double>(samples)));
    for (size_t p = 0; p < sum.size(); ++p) {
      sum[p] += film.mean(p).x;
      squares[p] += film.mean(p).x * film.mean(p).x;
    }
  }
  double variance = 0, mean_square = 0;
  for (size_t p = 0; p < sum.size(); ++p) {
    const double mean = sum[p] / renders;
    variance += (squares[p] / renders - mean * mean) * renders / (renders - 1);
    mean_square += mean * mean;
  }
  m.relative_variance = variance / mean_square * static_cast<double>(samples);
  return m;
}

/// A sky with a sun in one texel.
std::shared_ptr<const Bitmap> sunny_sky() {
  auto sky = std::make_shared<Bitmap>();
  sky->width = 512;
  sky->height = 256;
  sky->channels = 3;
  for (int y = 0; y < sky->height; ++y)
    for (int x = 0; x < sky->width; ++x) {
      const bool sun = x == 300 && y == 70;
      for (int c = 0; c < 3; ++c) sky->floats.push_back(sun ? 1e5f : y < 128 ? 0.8f + 0.1f * static_cast<float>(c) : 0.2f);
    }
  return sky;
}

}  // namespace

std::vector<LightsResult> bench_lights(bool large, int repetitions) {
  vulkan::Device device;
  std::vector<LightsResult> results;
  std::vector<uint32_t> counts = {1, 10, 1000, 100000};
  if (large) counts.push_back(1000000);
  for (const uint32_t count : counts) {
    LightsResult r;
    r.lights = count;
    PackedScene packed = pack_scene(field_of_lights(count, count));
    const Measured ours = measure(device, packed, 64, repetitions);
    choose_uniformly(packed);
    r.uniform_variance = measure(device, packed, 64, repetitions).relative_variance;
    r.uniform_ns_per_path = measure(device, pack_scene(field_of_lights(count, 1)), 64, repetitions).ns_per_path;
    r.ns_per_path = ours.ns_per_path;
    r.relative_variance = ours.relative_variance;
    results.push_back(r);
  }
  return results;
}

std::vector<SunResult> bench_sun(int repetitions) {
  Scene scene = direct_light_scene();
  scene.sensors.push_back(look_down(20, kSeen));
  add_shape(scene, SphereShape{{0, 1, 0}, 1}, glm::dmat4(1), 0.5);
  scene.emitters.push_back({{}, "envmap", EnvironmentEmitter{sunny_sky(), false, 1, glm::rotate(glm::dmat4(1), 0.5, glm::dvec3(1, 2, 3))}, kNone});
  vulkan::Device device;
  std::vector<SunResult> results;
  using Strategy = Integrator::Strategy;
  for (const auto& [name, strategy] : {std::pair("mis", Strategy::kMis), std::pair("emitter", Strategy::kEmitterOnly),
                                       std::pair("bsdf", Strategy::kBsdfOnly)}) {
    scene.integrator.strategy = strategy;
    const Measured m = measure(device, pack_scene(scene), 16, repetitions);
    results.push_back({name, m.relative_variance / 16, m.ns_per_path});
  }
  return results;
}

}  // namespace tachylite::bench
