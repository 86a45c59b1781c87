#include "reference/bsdf/rough_conductor.h"

#include "reference/bsdf/fresnel.h"
#include "reference/bsdf/microfacet.h"

namespace tachylite::reference {

std::optional<BsdfSample> sample_bsdf(const RoughConductorBsdf& bsdf, const ShadingPoint& point,
                                      const dvec3& wo, Random& random) {
  if (wo.z <= 0) return std::nullopt;
  const dvec3 m = Microfacets(bsdf.roughness, point).sample(wo, random.uniform2());
  return finish_sample(bsdf, point, wo, reflect(wo, m));
}

double pdf_bsdf(const RoughConductorBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z <= 0 || wi.z <= 0) return 0;
  const dvec3 m = glm::normalize(wo + wi);
  return Microfacets(bsdf.roughness, point).pdf(wo, m) / (4 * glm::dot(wo, m));
}

dvec3 eval_bsdf(const RoughConductorBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z <= 0 || wi.z <= 0) return dvec3(0);
  const dvec3 m = glm::normalize(wo + wi);
  const Microfacets microfacets(bsdf.roughness, point);
  const dvec3 f = fresnel_conductor(glm::dot(wo, m), point.color(bsdf.eta), point.color(bsdf.k));
  return f * point.color(bsdf.specular_reflectance) *
         (microfacets.d(m) * microfacets.g(wo, wi, m) / (4 * wo.z));
}

}  // namespace tachylite::reference
