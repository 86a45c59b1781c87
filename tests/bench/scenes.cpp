#include "bench/scenes.h"

#include <stdexcept>

#include "support/pcg32.h"

namespace tachylite::bench {
namespace {

using test::TestMesh;
using test::Pcg32;

void add_light(BenchScene& scene) {
  scene.mesh.add_parallelogram(scene.light.corner, scene.light.edge_u, scene.light.edge_v);
}

BenchScene make_cornell() {
  BenchScene scene{
      "cornell", {}, {{0, -2.15f, 0}, {0, 1.25f, 0}, 40, 512}, {{-0.25f, 1.05f, 0.995f}, {0, 0.4f, 0}, {0.5f, 0, 0}}};
  scene.mesh.add_box({0, 0, 0}, {1, 0, 0}, {0, 2.25f, 0}, {0, 0, 1});
  const auto rotated = [](float angle, float half) {
    return std::pair{glm::vec3(glm::cos(angle), glm::sin(angle), 0) * half,
                     glm::vec3(-glm::sin(angle), glm::cos(angle), 0) * half};
  };
  const auto [tall_x, tall_y] = rotated(0.30f, 0.3f);
  scene.mesh.add_box({-0.34f, 1.55f, -0.4f}, tall_x, tall_y, {0, 0, 0.6f});
  const auto [short_x, short_y] = rotated(-0.28f, 0.3f);
  scene.mesh.add_box({0.34f, 0.90f, -0.7f}, short_x, short_y, {0, 0, 0.3f});
  add_light(scene);
  return scene;
}

BenchScene make_plates() {
  BenchScene scene{
      "plates", {}, {{0, -0.9f, 0}, {0, 0, 0}, 80, 512}, {{-0.25f, -0.25f, 0.995f}, {0, 0.5f, 0}, {0.5f, 0, 0}}};
  scene.mesh.add_box({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  Pcg32 random(3);
  for (int i = 0; i < 12; ++i) {
    const glm::vec3 centre = random.in_box({-0.6f, -0.4f, -0.7f}, {0.6f, 0.7f, 0.6f}), u = 0.4f * random.direction();
    const glm::vec3 v = 0.4f * glm::normalize(glm::cross(u, random.direction()));
    scene.mesh.add_parallelogram(centre - 0.5f * (u + v), u, v);
  }
  add_light(scene);
  return scene;
}

BenchScene make_room(const std::string& name, uint32_t rings, uint32_t segments) {
  constexpr glm::vec3 kSize{10, 10, 4};
  BenchScene scene{name, {}, {{0.5f, 0.6f, 2.2f}, {6, 6.5f, 1.4f}, 75, name == "big" ? 512u : 384u},
              {{3.5f, 3.5f, 3.95f}, {0, 3, 0}, {3, 0, 0}}};
  Pcg32 random(1);
  scene.mesh.add_box(0.5f * kSize, {0.5f * kSize.x, 0, 0}, {0, 0.5f * kSize.y, 0}, {0, 0, 0.5f * kSize.z});
  for (uint64_t i = 0; i < 60; ++i) {
    const float radius = random.uniform(0.2f, 0.6f);
    const glm::vec3 centre = random.in_box({1.2f, 1.2f, radius}, {9.3f, 9.3f, 3.2f});
    scene.mesh.append(test::make_displaced_sphere(centre, radius, 0.35f, rings, segments, 100 + i));
  }
  for (int i = 0; i < 12; ++i) {
    const float angle = random.uniform(0, 3), half = random.uniform(0.15f, 0.5f), height = random.uniform(0.1f, 0.8f);
    const glm::vec3 x(glm::cos(angle), glm::sin(angle), 0), y(-x.y, x.x, 0);
    const glm::vec3 place = random.in_box({1.5f, 1.5f, 0}, {9, 9, 0});
    scene.mesh.add_box({place.x, place.y, height}, x * half, y * half, {0, 0, height});
  }
  for (int i = 0; i < 16; ++i) {
    const glm::vec3 foot = random.in_box({1, 1, 0}, {9.5f, 9.5f, 0});
    const glm::vec3 lean(random.uniform(-0.4f, 0.4f), random.uniform(-0.4f, 0.4f), 2);
    scene.mesh.add_box(foot + lean, {0.025f, 0, 0}, {0, 0.025f, 0}, lean);
  }
  add_light(scene);
  return scene;
}

}  // namespace

BenchScene make_scene(const std::string& name) {
  if (name == "cornell") return make_cornell();
  if (name == "plates") return make_plates();
  if (name == "room") return make_room(name, 32, 64);
  if (name == "big") return make_room(name, 90, 180);
  throw std::invalid_argument("no bench scene is called " + name);
}

std::vector<std::string> scene_names() { return {"room", "cornell", "plates", "big"}; }
std::vector<std::string> tiny_scene_names() { return {"cornell", "plates"}; }

}  // namespace tachylite::bench
