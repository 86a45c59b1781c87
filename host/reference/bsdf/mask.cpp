#include "reference/bsdf/mask.h"

namespace tachylite::reference {
namespace {

double opacity(const MaskBsdf& bsdf, const ShadingPoint& point) {
  return std::clamp(point.scalar(bsdf.opacity), 0.0, 1.0);
}

}  // namespace

std::optional<BsdfSample> sample_bsdf(const MaskBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random) {
  const double a = opacity(bsdf, point);
  if (!(random.uniform() < a)) return BsdfSample{-wo, dvec3(1), 1 - a, Scattering::kNull};
  auto sample = sample_bsdf(bsdf.child, point, wo, random);
  if (sample) sample->pdf *= a;
  return sample;
}

double pdf_bsdf(const MaskBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  return opacity(bsdf, point) * pdf_bsdf(bsdf.child, point, wo, wi);
}

dvec3 eval_bsdf(const MaskBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  return opacity(bsdf, point) * eval_bsdf(bsdf.child, point, wo, wi);
}

dvec3 null_transmission(const MaskBsdf& bsdf, const ShadingPoint& point, const dvec3& wo) {
  const double a = opacity(bsdf, point);
  return 1 - a + a * null_transmission(bsdf.child, point, wo);
}

}  // namespace tachylite::reference
