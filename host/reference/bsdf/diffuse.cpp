#include "reference/bsdf/diffuse.h"

namespace tachylite::reference {

std::optional<BsdfSample> sample_bsdf(const DiffuseBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random) {
  return finish_sample(bsdf, point, wo, sample_cosine_hemisphere(random.uniform2()));
}

double pdf_bsdf(const DiffuseBsdf&, const ShadingPoint&, const dvec3& wo, const dvec3& wi) {
  return wo.z > 0 ? pdf_cosine_hemisphere(wi.z) : 0;
}

dvec3 eval_bsdf(const DiffuseBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z <= 0 || wi.z <= 0) return dvec3(0);
  return point.color(bsdf.reflectance) * (wi.z / kPi);
}

}  // namespace tachylite::reference
