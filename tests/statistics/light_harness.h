#pragma once

// Runs light/light.glsl over arrays, for a scene that a test has made.

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "pack/pack_light.h"
#include "scene/scene.h"
#include "support/device_test.h"

namespace tachylite::test {

struct LightQuery {
  glm::vec3 p{0}, n{0};
  glm::vec2 u{0};
  float u_select = 0;
};
struct LightAnswer {
  glm::vec3 wi{0}, to_light{0}, radiance{0};
  float pdf = 0, key = 0;
  uint32_t target = 0;
  bool delta = false;
};
/// A ray from p that hit the light of shape `shape`, or (shape < 0) escaped.
struct LightHit {
  glm::vec3 p{0}, d{0}, n_s{0};
  glm::vec2 uv{0};
  float key = 0, t = 1;
  int shape = -1;
  uint32_t primitive = 0;  // device triangle
};
struct LightValue {
  glm::vec3 radiance{0};
  float pdf = 0;
};

/// A scene's lights on the device. Device space is moved from world space by centre().
class LightHarness {
 public:
  explicit LightHarness(const Scene& scene);

  std::vector<LightAnswer> sample(std::span<const LightQuery> queries);
  std::vector<LightValue> evaluate(std::span<const LightHit> hits);
  /// The primitive that a target names, and its shape.
  uint32_t primitive_of(uint32_t target) const;
  int shape_of(uint32_t primitive) const;

  const Geometry& geometry() const { return geometry_; }
  const PackedLights& lights() const { return lights_; }
  glm::dvec3 centre() const { return geometry_.centre; }

 private:
  std::vector<glm::vec4> run(std::span<const glm::vec4> items, uint32_t mode);
  Geometry geometry_;
  Bvh8 bvh_;
  PackedTextures textures_;
  PackedLights lights_;
  KernelRun run_;
};

/// Scenes in code.
int add_shape(Scene& scene, decltype(Shape::kind) kind, const glm::dmat4& to_world);
/// Makes shape `shape` emit; returns the emitter.
int add_area_light(Scene& scene, int shape, const ColorInput& radiance);
int add_emitter(Scene& scene, decltype(Emitter::kind) kind);
int add_bitmap_texture(Scene& scene, std::shared_ptr<const Bitmap> bitmap, bool raw);
glm::dmat4 placed(const glm::dvec3& position, const glm::dvec3& scale, const glm::dvec3& axis = {0, 0, 1},
                  double degrees = 0);

/// 24-bit numbers in [0, 1), as the samplers give.
class Uniform {
 public:
  explicit Uniform(uint32_t seed) : engine_(seed) {}
  float operator()() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }
  glm::vec2 two() {
    const float x = (*this)();
    return {x, (*this)()};
  }

 private:
  std::mt19937 engine_;
};

}  // namespace tachylite::test
