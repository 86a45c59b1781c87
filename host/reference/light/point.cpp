#include "reference/light/point.h"

namespace tachylite::reference {
namespace {

/// A sample of the point `position` with that irradiance.
std::optional<LightSample> towards(const dvec3& position, const dvec3& receiver, const dvec3& irradiance) {
  if (is_black(irradiance) || position == receiver) return std::nullopt;
  return LightSample{glm::normalize(position - receiver), irradiance, 1, true, position};
}

}  // namespace

std::optional<LightSample> sample_point_light(const PointEmitter& emitter, const dvec3& receiver) {
  const dvec3 d = emitter.position - receiver;
  return towards(emitter.position, receiver, emitter.intensity / glm::dot(d, d));
}

std::optional<LightSample> sample_spot_light(const SpotEmitter& emitter, const Scene& scene,
                                             const dvec3& receiver) {
  const dvec3 position(emitter.to_world[3]);
  const dvec3 d = receiver - position;
  const dvec3 local = glm::normalize(glm::inverse(dmat3(emitter.to_world)) * d);
  const double theta = std::atan2(std::hypot(local.x, local.y), local.z);
  const double cutoff = emitter.cutoff_angle, beam = emitter.beam_width;
  if (theta >= cutoff) return std::nullopt;
  const double falloff = theta <= beam ? 1 : (cutoff - theta) / (cutoff - beam);
  dvec3 intensity = emitter.intensity * falloff;
  if (emitter.texture != kNone) {
    const dvec2 uv = 0.5 + 0.5 * dvec2(local) / (local.z * std::tan(cutoff));
    intensity *= eval_texture(scene, emitter.texture, {.uv = uv});
  }
  return towards(position, receiver, intensity / glm::dot(d, d));
}

std::optional<LightSample> sample_projector_light(const ProjectorEmitter& emitter, const Scene& scene,
                                                  const dvec3& receiver) {
  const dvec3 local = transform_point(glm::inverse(emitter.to_world), receiver);
  if (local.z <= 0) return std::nullopt;
  double aspect = 1;
  if (emitter.irradiance != kNone) {
    const Texture& texture = scene.textures[static_cast<size_t>(emitter.irradiance)];
    if (const auto* bitmap = std::get_if<BitmapTexture>(&texture.kind)) {
      aspect = static_cast<double>(bitmap->bitmap->width) / bitmap->bitmap->height;
    }
  }
  const double half_width = local.z * std::tan(0.5 * emitter.x_fov);
  const dvec2 uv = 0.5 - 0.5 * dvec2(local.x, local.y * aspect) / half_width;
  if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) return std::nullopt;
  const dvec3 irradiance = emitter.irradiance != kNone ? eval_texture(scene, emitter.irradiance, {.uv = uv})
                                                       : emitter.irradiance_value;
  const double cos_theta = local.z / glm::length(local);
  return towards(dvec3(emitter.to_world[3]), receiver,
                 irradiance * (kPi * emitter.scale / (sqr(local.z) * cos_theta)));
}

std::optional<LightSample> sample_directional_light(const DirectionalEmitter& emitter) {
  return LightSample{-glm::normalize(emitter.direction), emitter.irradiance, 1, true, std::nullopt};
}

}  // namespace tachylite::reference
