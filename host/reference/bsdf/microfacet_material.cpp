#include "reference/bsdf/microfacet_material.h"

#include "reference/bsdf/fresnel.h"
#include "reference/bsdf/microfacet.h"

namespace tachylite::reference {
namespace {

Microfacets coat(const MicrofacetBsdf& bsdf, const ShadingPoint& point) {
  const double alpha = point.scalar(bsdf.alpha);
  return Microfacets(MicrofacetDistribution::kBeckmann, alpha, alpha);
}

double specular_weight(const MicrofacetBsdf& bsdf, const ShadingPoint& point) {
  return std::clamp(1 - max_component(point.color(bsdf.kd)), 0.0, 1.0);
}

}  // namespace

std::optional<BsdfSample> sample_bsdf(const MicrofacetBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random) {
  if (wo.z <= 0) return std::nullopt;
  const bool specular = random.uniform() < specular_weight(bsdf, point);
  const dvec2 u = random.uniform2();
  const dvec3 wi = specular ? reflect(wo, coat(bsdf, point).sample(wo, u)) : sample_cosine_hemisphere(u);
  return finish_sample(bsdf, point, wo, wi);
}

double pdf_bsdf(const MicrofacetBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z <= 0 || wi.z <= 0) return 0;
  const dvec3 m = glm::normalize(wo + wi);
  return lerp(pdf_cosine_hemisphere(wi.z), coat(bsdf, point).pdf(wo, m) / (4 * glm::dot(wo, m)),
              specular_weight(bsdf, point));
}

dvec3 eval_bsdf(const MicrofacetBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z <= 0 || wi.z <= 0) return dvec3(0);
  const dvec3 m = glm::normalize(wo + wi);
  const Microfacets microfacets = coat(bsdf, point);
  const double f = fresnel_dielectric(glm::dot(wo, m), bsdf.int_ior / bsdf.ext_ior);
  const double specular = f * microfacets.d(m) * microfacets.g(wo, wi, m) / (4 * wo.z);
  return point.color(bsdf.kd) * (wi.z / kPi) + specular_weight(bsdf, point) * specular;
}

}  // namespace tachylite::reference
