#include "reference/bsdf/blend.h"

namespace tachylite::reference {
namespace {

double weight_of_second(const BlendBsdf& bsdf, const ShadingPoint& point) {
  return std::clamp(point.scalar(bsdf.weight), 0.0, 1.0);
}

}  // namespace

std::optional<BsdfSample> sample_bsdf(const BlendBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random) {
  const double w = weight_of_second(bsdf, point);
  const bool second = random.uniform() < w;
  auto sample = sample_bsdf(second ? bsdf.second : bsdf.first, point, wo, random);
  if (!sample) return sample;
  if (sample->kind == Scattering::kSmooth) return finish_sample(bsdf, point, wo, sample->wi, sample->eta);
  sample->pdf *= second ? w : 1 - w;
  return sample;
}

double pdf_bsdf(const BlendBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  return lerp(pdf_bsdf(bsdf.first, point, wo, wi), pdf_bsdf(bsdf.second, point, wo, wi),
              weight_of_second(bsdf, point));
}

dvec3 eval_bsdf(const BlendBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  const double w = weight_of_second(bsdf, point);
  return (1 - w) * eval_bsdf(bsdf.first, point, wo, wi) + w * eval_bsdf(bsdf.second, point, wo, wi);
}

dvec3 null_transmission(const BlendBsdf& bsdf, const ShadingPoint& point, const dvec3& wo) {
  const double w = weight_of_second(bsdf, point);
  return (1 - w) * null_transmission(bsdf.first, point, wo) + w * null_transmission(bsdf.second, point, wo);
}

}  // namespace tachylite::reference
