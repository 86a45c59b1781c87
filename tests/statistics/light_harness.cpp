#include "statistics/light_harness.h"

#include <bit>

#include <glm/gtc/matrix_transform.hpp>

#include "shared/bindings.h"
#include "shared/features.h"
#include "shared/light.h"

namespace tachylite::test {
namespace {

constexpr size_t kRows = 4;
constexpr uint32_t kInput = 64, kOutput = 65;
struct Push {
  uint32_t count, mode;
};

/// Texel buffers must not be empty.
template <class T, class Allocator>
std::span<const T> at_least_one(std::vector<T, Allocator>& values) {
  if (values.empty()) values.resize(1);
  return values;
}

Bvh8 build(const Geometry& geometry) {
  BvhInput input;
  input.vertices = geometry.vertices;
  input.triangles = geometry.triangles;
  input.curved = geometry.curved;
  input.groups = geometry.shape_of_triangle;
  return build_bvh8(input);
}

}  // namespace

LightHarness::LightHarness(const Scene& scene)
    : geometry_(pack_geometry(scene)),
      bvh_(build(geometry_)),
      textures_(pack_textures(scene, geometry_)),
      lights_(pack_lights(scene, geometry_, bvh_, textures_)),
      run_("light_sample") {
  constexpr VkFormat kFloat4 = VK_FORMAT_R32G32B32A32_SFLOAT, kUint4 = VK_FORMAT_R32G32B32A32_UINT;
  run_.texels(gpu::kBindTextures, kUint4, at_least_one(textures_.rows))
      .texels(gpu::kBindTexels8, VK_FORMAT_R8G8B8A8_UNORM, at_least_one(textures_.texels8))
      .texels(gpu::kBindTexels16, VK_FORMAT_R16G16B16A16_SFLOAT, at_least_one(textures_.texels16))
      .texels(gpu::kBindTexels32, kFloat4, at_least_one(textures_.texels32))
      .texels(gpu::kBindAttributes, kFloat4, at_least_one(textures_.attributes))
      .texels(gpu::kBindLights, kFloat4, at_least_one(lights_.rows))
      .texels(gpu::kBindLightTable, kUint4, at_least_one(lights_.table))
      .texels(gpu::kBindEnvironment, kFloat4, at_least_one(lights_.environment))
      .texels(gpu::kBindEnvironmentCdf, kFloat4, at_least_one(lights_.environment_cdf))
      .constant(gpu::kFeatureLights, lights_.kinds)
      .constant(gpu::kFeatureSelection, lights_.selection)
      .constant(gpu::kFeatureLightTextures, lights_.textures)
      .constant(gpu::kFeatureTextures, textures_.kinds);
}

std::vector<glm::vec4> LightHarness::run(std::span<const glm::vec4> items, uint32_t mode) {
  const auto count = static_cast<uint32_t>(items.size() / kRows);
  run_.storage(kInput, items).output<glm::vec4>(kOutput, items.size()).push(Push{count, mode}).run(count);
  return run_.result<glm::vec4>(kOutput);
}

std::vector<LightAnswer> LightHarness::sample(std::span<const LightQuery> queries) {
  std::vector<glm::vec4> items;
  items.reserve(kRows * queries.size());
  for (const LightQuery& q : queries) {
    items.emplace_back(q.p, q.u_select);
    items.emplace_back(q.n, 0);
    items.emplace_back(q.u, 0, 0);
    items.emplace_back(0);
  }
  const std::vector<glm::vec4> results = run(items, 0);
  std::vector<LightAnswer> answers(queries.size());
  for (size_t i = 0; i < answers.size(); ++i) {
    const glm::vec4* r = &results[kRows * i];
    answers[i] = {r[0], r[1], r[2], r[0].w, r[2].w, std::bit_cast<uint32_t>(r[1].w), r[3].x != 0};
  }
  return answers;
}

std::vector<LightValue> LightHarness::evaluate(std::span<const LightHit> hits) {
  std::vector<glm::vec4> items;
  items.reserve(kRows * hits.size());
  for (const LightHit& h : hits) {
    const uint32_t light = h.shape < 0 ? 0xffffffffu : lights_.light_of_shape[static_cast<size_t>(h.shape)];
    items.emplace_back(h.p, h.key);
    items.emplace_back(h.d, h.t);
    items.emplace_back(h.n_s, std::bit_cast<float>(light));
    items.emplace_back(h.uv, std::bit_cast<float>(h.primitive), 0);
  }
  const std::vector<glm::vec4> results = run(items, 1);
  std::vector<LightValue> values(hits.size());
  for (size_t i = 0; i < values.size(); ++i) {
    const glm::vec4& r = results[kRows * i + (hits[i].shape < 0 ? 1 : 0)];
    values[i] = {glm::vec3(r), r.w};
  }
  return values;
}

uint32_t LightHarness::primitive_of(uint32_t target) const {
  const glm::uvec4 info = bvh_.leaves.at(target >> 1).info;
  return (target & 1u) != 0 ? info.y : info.x;
}

int LightHarness::shape_of(uint32_t primitive) const {
  const size_t triangles = geometry_.triangles.size();
  return static_cast<int>(primitive < triangles ? geometry_.shape_of_triangle.at(primitive)
                                                : geometry_.shape_of_curved.at(primitive - triangles));
}

int add_shape(Scene& scene, decltype(Shape::kind) kind, const glm::dmat4& to_world) {
  Shape shape;
  shape.kind = std::move(kind);
  shape.to_world = to_world;
  scene.shapes.push_back(std::move(shape));
  return static_cast<int>(scene.shapes.size()) - 1;
}

int add_emitter(Scene& scene, decltype(Emitter::kind) kind) {
  Emitter emitter;
  emitter.kind = std::move(kind);
  scene.emitters.push_back(std::move(emitter));
  return static_cast<int>(scene.emitters.size()) - 1;
}

int add_area_light(Scene& scene, int shape, const ColorInput& radiance) {
  const int emitter = add_emitter(scene, AreaEmitter{radiance});
  scene.emitters.back().shape = shape;
  scene.shapes[static_cast<size_t>(shape)].emitter = emitter;
  return emitter;
}

int add_bitmap_texture(Scene& scene, std::shared_ptr<const Bitmap> bitmap, bool raw) {
  BitmapTexture texture;
  texture.format = bitmap->bytes.empty() ? (bitmap->half ? TexelFormat::kHalf : TexelFormat::kFloat)
                   : raw                 ? TexelFormat::kUnorm8Linear
                                         : TexelFormat::kUnorm8Srgb;
  texture.raw = raw;
  texture.bitmap = std::move(bitmap);
  Texture t;
  t.kind = texture;
  scene.textures.push_back(t);
  return static_cast<int>(scene.textures.size()) - 1;
}

glm::dmat4 placed(const glm::dvec3& position, const glm::dvec3& scale, const glm::dvec3& axis, double degrees) {
  return glm::translate(glm::dmat4(1), position) * glm::rotate(glm::dmat4(1), glm::radians(degrees), axis) *
         glm::scale(glm::dmat4(1), scale);
}

}  // namespace tachylite::test
