#include "reference/bsdf/rough_dielectric.h"

#include "reference/bsdf/fresnel.h"
#include "reference/bsdf/microfacet.h"

namespace tachylite::reference {
std::optional<BsdfSample> sample_bsdf(const RoughDielectricBsdf& bsdf, const ShadingPoint& point,
                                      const dvec3& wo, Random& random) {
  if (wo.z == 0) return std::nullopt;
  const dvec3 m = Microfacets(bsdf.roughness, point).sample(wo, random.uniform2());
  const DielectricBoundary boundary = dielectric_boundary(glm::dot(wo, m), bsdf.eta);
  const bool reflection = random.uniform() < boundary.reflectance;
  const dvec3 wi = reflection ? reflect(wo, m) : refract(wo, m, boundary.cos_t, boundary.eta_ti);
  if ((wo.z * wi.z > 0) != reflection) return std::nullopt;
  return finish_sample(bsdf, point, wo, wi, reflection ? 1 : boundary.eta_ti);
}

double pdf_bsdf(const RoughDielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                const dvec3& wi) {
  if (wo.z * wi.z == 0) return 0;
  const dvec3 m = half_vector(bsdf.eta, wo, wi);
  const double mo = glm::dot(wo, m), mi = glm::dot(wi, m);
  if (mo * wo.z <= 0 || mi * wi.z <= 0) return 0;
  const DielectricBoundary boundary = dielectric_boundary(mo, bsdf.eta);
  const double pdf_m = Microfacets(bsdf.roughness, point).pdf(wo, m), f = boundary.reflectance;
  if (wo.z * wi.z > 0) return f * pdf_m / (4 * std::abs(mi));  // eq. 14
  const double eta = boundary.eta_ti;
  return (1 - f) * pdf_m * sqr(eta) * std::abs(mi) / sqr(mo + eta * mi);  // eq. 17
}

dvec3 eval_bsdf(const RoughDielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                const dvec3& wi) {
  if (wo.z * wi.z == 0) return dvec3(0);
  const dvec3 m = half_vector(bsdf.eta, wo, wi);
  const double mo = glm::dot(wo, m), mi = glm::dot(wi, m);
  const Microfacets microfacets(bsdf.roughness, point);
  const DielectricBoundary boundary = dielectric_boundary(mo, bsdf.eta);
  const double dg = microfacets.d(m) * microfacets.g(wo, wi, m), f = boundary.reflectance;
  if (wo.z * wi.z > 0) return point.color(bsdf.specular_reflectance) * (f * dg / (4 * std::abs(wo.z)));
  // eq. 21 times |cos_i|, over eta^2
  const double eta = boundary.eta_ti;
  return point.color(bsdf.specular_transmittance) *
         ((1 - f) * dg * std::abs(mo * mi / wo.z) / sqr(mo + eta * mi));
}

}  // namespace tachylite::reference
