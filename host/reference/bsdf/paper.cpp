#include "reference/bsdf/paper.h"

namespace tachylite::reference {
namespace {

double transparency(const PaperBsdf& bsdf, const ShadingPoint& point) {
  return std::clamp(point.scalar(bsdf.transparency), 0.0, 1.0);
}

}  // namespace

std::optional<BsdfSample> sample_bsdf(const PaperBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random) {
  const double t = transparency(bsdf, point);
  if (random.uniform() < t) return BsdfSample{-wo, dvec3(1), t, Scattering::kNull};
  dvec3 wi = sample_cosine_hemisphere(random.uniform2());
  if (wo.z < 0) wi.z = -wi.z;
  return finish_sample(bsdf, point, wo, wi);
}

double pdf_bsdf(const PaperBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  return wo.z * wi.z > 0 ? (1 - transparency(bsdf, point)) * pdf_cosine_hemisphere(std::abs(wi.z)) : 0;
}

dvec3 eval_bsdf(const PaperBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z * wi.z <= 0) return dvec3(0);
  return point.color(bsdf.reflectance) * ((1 - transparency(bsdf, point)) * std::abs(wi.z) / kPi);
}

dvec3 null_transmission(const PaperBsdf& bsdf, const ShadingPoint& point, const dvec3&) {
  return dvec3(transparency(bsdf, point));
}

}  // namespace tachylite::reference
