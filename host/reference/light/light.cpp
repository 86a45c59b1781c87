#include "reference/light/light.h"

#include "reference/light/area.h"
#include "reference/light/point.h"

namespace tachylite::reference {

Lights::Lights(const Geometry& geometry) : geometry_(geometry), scene_(geometry.scene()) {
  for (const Emitter& emitter : scene_.emitters) {
    const auto* environment = std::get_if<EnvironmentEmitter>(&emitter.kind);
    envmaps_.push_back(environment ? std::make_unique<Envmap>(*environment) : nullptr);
    if (!std::holds_alternative<DirectionalAreaEmitter>(emitter.kind)) {
      sampled_.push_back(static_cast<int>(envmaps_.size()) - 1);
    }
  }
}

std::optional<LightSample> Lights::sample_light(const dvec3& receiver, Random& random) const {
  if (sampled_.empty()) return std::nullopt;
  const double n = static_cast<double>(sampled_.size());
  const auto index = static_cast<size_t>(sampled_[static_cast<size_t>(random.uniform() * n)]);
  const Emitter& emitter = scene_.emitters[index];

  std::optional<LightSample> sample;
  if (const auto* area = std::get_if<AreaEmitter>(&emitter.kind)) {
    sample = sample_area_light(*area, emitter.shape, geometry_, receiver, random);
  } else if (const auto* constant = std::get_if<ConstantEmitter>(&emitter.kind)) {
    const double pdf = 1 / (4 * kPi);
    sample =
        LightSample{sample_sphere(random.uniform2()), constant->radiance / pdf, pdf, false, std::nullopt};
  } else if (const Envmap* envmap = envmaps_[index].get()) {
    const dvec3 wi = envmap->sample_direction(random);
    const double pdf = envmap->pdf_direction(wi);
    if (pdf > 0) sample = LightSample{wi, envmap->radiance(wi) / pdf, pdf, false, std::nullopt};
  } else if (const auto* point = std::get_if<PointEmitter>(&emitter.kind)) {
    sample = sample_point_light(*point, receiver);
  } else if (const auto* spot = std::get_if<SpotEmitter>(&emitter.kind)) {
    sample = sample_spot_light(*spot, scene_, receiver);
  } else if (const auto* projector = std::get_if<ProjectorEmitter>(&emitter.kind)) {
    sample = sample_projector_light(*projector, scene_, receiver);
  } else if (const auto* directional = std::get_if<DirectionalEmitter>(&emitter.kind)) {
    sample = sample_directional_light(*directional);
  }

  if (sample) {  // account for the choice
    sample->weight *= n;
    sample->pdf /= n;
  }
  return sample;
}

Ray Lights::shadow_ray(const dvec3& origin, const LightSample& sample) {
  if (sample.target) return {origin, *sample.target - origin, 1};
  return {origin, sample.wi};
}

dvec3 Lights::emitted(const SurfacePoint& surface, const dvec3& wo) const {
  const EmitterIndex index = scene_.shapes[static_cast<size_t>(surface.shape)].emitter;
  if (index == kNone) return dvec3(0);
  const auto* area = std::get_if<AreaEmitter>(&scene_.emitters[static_cast<size_t>(index)].kind);
  return area ? emitted_area(*area, scene_, surface, wo) : dvec3(0);
}

double Lights::pdf_surface(const dvec3& receiver, const SurfacePoint& surface) const {
  return pdf_area_light(geometry_, receiver, surface) / static_cast<double>(sampled_.size());
}

dvec3 Lights::environment(const dvec3& direction) const {
  dvec3 sum(0);
  for (size_t i = 0; i < envmaps_.size(); ++i) {
    if (const auto* constant = std::get_if<ConstantEmitter>(&scene_.emitters[i].kind))
      sum += constant->radiance;
    if (envmaps_[i]) sum += envmaps_[i]->radiance(direction);
  }
  return sum;
}

double Lights::pdf_environment(const dvec3& direction) const {
  double sum = 0;
  for (size_t i = 0; i < envmaps_.size(); ++i) {
    if (std::holds_alternative<ConstantEmitter>(scene_.emitters[i].kind)) sum += 1 / (4 * kPi);
    if (envmaps_[i]) sum += envmaps_[i]->pdf_direction(direction);
  }
  return sum / static_cast<double>(sampled_.size());
}

}  // namespace tachylite::reference
