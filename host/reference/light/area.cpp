#include "reference/light/area.h"

namespace tachylite::reference {

dvec3 emitted_area(const AreaEmitter& emitter, const Scene& scene, const SurfacePoint& surface,
                   const dvec3& wo) {
  if (glm::dot(surface.frame.n, wo) <= 0) return dvec3(0);
  return eval_color(scene, emitter.radiance, surface.at);
}

double pdf_area_light(const Geometry& geometry, const dvec3& receiver, const SurfacePoint& surface) {
  const dvec3 d = surface.p - receiver;
  const double distance2 = glm::dot(d, d);
  // Mitsuba converts area to solid angle by the shading normal; its images, which are the standard, depend on it.
  const double cos_light = std::abs(glm::dot(surface.frame.n, d)) / std::sqrt(distance2);
  return cos_light > 0 ? distance2 / (geometry.area(surface.shape) * cos_light) : 0;
}

std::optional<LightSample> sample_area_light(const AreaEmitter& emitter, int shape, const Geometry& geometry,
                                             const dvec3& receiver, Random& random) {
  const AreaSample sample = geometry.sample_area(shape, random);
  const SurfacePoint& surface = sample.point;
  const dvec3 wi = glm::normalize(surface.p - receiver);
  const dvec3 radiance = emitted_area(emitter, geometry.scene(), surface, -wi);
  const double pdf = pdf_area_light(geometry, receiver, surface);
  if (!(pdf > 0) || is_black(radiance)) return std::nullopt;
  return LightSample{wi, radiance / pdf, pdf, false, surface.offset_towards(-wi)};
}

}  // namespace tachylite::reference
