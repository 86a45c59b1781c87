#include "reference/bsdf/two_sided.h"

namespace tachylite::reference {
namespace {

dvec3 mirror(const dvec3& w) {
  return {w.x, w.y, -w.z};
}

}  // namespace

std::optional<BsdfSample> sample_bsdf(const TwoSidedBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random) {
  if (wo.z >= 0) return sample_bsdf(bsdf.front, point, wo, random);
  auto sample = sample_bsdf(bsdf.back, point, mirror(wo), random);
  if (sample) sample->wi = mirror(sample->wi);
  return sample;
}

double pdf_bsdf(const TwoSidedBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  return wo.z >= 0 ? pdf_bsdf(bsdf.front, point, wo, wi) : pdf_bsdf(bsdf.back, point, mirror(wo), mirror(wi));
}

dvec3 eval_bsdf(const TwoSidedBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  return wo.z >= 0 ? eval_bsdf(bsdf.front, point, wo, wi)
                   : eval_bsdf(bsdf.back, point, mirror(wo), mirror(wi));
}

}  // namespace tachylite::reference
