#include "reference/bsdf/conductor.h"

#include "reference/bsdf/fresnel.h"

namespace tachylite::reference {

std::optional<BsdfSample> sample_bsdf(const ConductorBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random&) {
  if (wo.z <= 0) return std::nullopt;
  const dvec3 f = fresnel_conductor(wo.z, point.color(bsdf.eta), point.color(bsdf.k));
  return BsdfSample{{-wo.x, -wo.y, wo.z}, f * point.color(bsdf.specular_reflectance), 1, Scattering::kDelta};
}

double pdf_bsdf(const ConductorBsdf&, const ShadingPoint&, const dvec3&, const dvec3&) {
  return 0;
}
dvec3 eval_bsdf(const ConductorBsdf&, const ShadingPoint&, const dvec3&, const dvec3&) {
  return dvec3(0);
}

}  // namespace tachylite::reference
