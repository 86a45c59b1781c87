#include "reference/bsdf/blinn_phong.h"

#include "reference/bsdf/fresnel.h"

namespace tachylite::reference {
namespace {

/// The two coefficients after specular_weight, or after the limit kd + ks <= 1.
struct Coefficients {
  dvec3 kd, ks;
};

Coefficients coefficients(const BlinnPhongBsdf& bsdf, const ShadingPoint& point) {
  const dvec3 kd = point.color(bsdf.diffuse_reflectance), ks = point.color(bsdf.specular_reflectance);
  if (bsdf.specular_weight) {
    const double w = std::clamp(point.scalar(*bsdf.specular_weight), 0.0, 1.0);
    return {(1 - w) * kd, w * ks};
  }
  return {kd, glm::min(ks, glm::max(1.0 - kd, dvec3(0)))};
}

double specular_probability(const Coefficients& c) {
  const double d = luminance(c.kd), s = luminance(c.ks);
  return s + d > 0 ? s / (s + d) : 0;
}

}  // namespace

std::optional<BsdfSample> sample_bsdf(const BlinnPhongBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random) {
  if (wo.z <= 0) return std::nullopt;
  const bool specular = random.uniform() < specular_probability(coefficients(bsdf, point));
  const dvec2 u = random.uniform2();
  if (!specular) return finish_sample(bsdf, point, wo, sample_cosine_hemisphere(u));
  // h with density (n+1)/(2 pi) cos^n
  const double cos_h = std::pow(1 - u.x, 1 / (point.scalar(bsdf.exponent) + 1));
  const double sin_h = std::sqrt(std::max(0.0, 1 - cos_h * cos_h)), phi = 2 * kPi * u.y;
  const dvec3 wi = reflect(wo, {sin_h * std::cos(phi), sin_h * std::sin(phi), cos_h});
  return finish_sample(bsdf, point, wo, wi);
}

double pdf_bsdf(const BlinnPhongBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z <= 0 || wi.z <= 0) return 0;
  const dvec3 h = glm::normalize(wo + wi);
  const double n = point.scalar(bsdf.exponent);
  const double pdf_h = (n + 1) / (2 * kPi) * std::pow(h.z, n);
  const double p = specular_probability(coefficients(bsdf, point));
  return lerp(pdf_cosine_hemisphere(wi.z), pdf_h / (4 * glm::dot(wo, h)), p);
}

dvec3 eval_bsdf(const BlinnPhongBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z <= 0 || wi.z <= 0) return dvec3(0);
  const Coefficients c = coefficients(bsdf, point);
  const dvec3 h = glm::normalize(wo + wi);
  const double n = point.scalar(bsdf.exponent);
  return (c.kd / kPi + c.ks * ((n + 2) / (2 * kPi) * std::pow(h.z, n))) * wi.z;
}

}  // namespace tachylite::reference
