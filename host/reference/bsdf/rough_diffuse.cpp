#include "reference/bsdf/rough_diffuse.h"

namespace tachylite::reference {

std::optional<BsdfSample> sample_bsdf(const RoughDiffuseBsdf& bsdf, const ShadingPoint& point,
                                      const dvec3& wo, Random& random) {
  return finish_sample(bsdf, point, wo, sample_cosine_hemisphere(random.uniform2()));
}

double pdf_bsdf(const RoughDiffuseBsdf&, const ShadingPoint&, const dvec3& wo, const dvec3& wi) {
  return wo.z > 0 ? pdf_cosine_hemisphere(wi.z) : 0;
}

dvec3 eval_bsdf(const RoughDiffuseBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z <= 0 || wi.z <= 0) return dvec3(0);
  const dvec3 rho = point.color(bsdf.reflectance);
  const double s2 = 0.5 * sqr(point.scalar(bsdf.alpha));  // sigma^2
  const double theta_o = std::acos(std::min(wo.z, 1.0)), theta_i = std::acos(std::min(wi.z, 1.0));
  const double alpha = std::max(theta_o, theta_i), beta = std::min(theta_o, theta_i);
  const double sines = std::hypot(wo.x, wo.y) * std::hypot(wi.x, wi.y);
  const double cos_phi = sines > 0 ? (wo.x * wi.x + wo.y * wi.y) / sines : 0;
  const double c1 = 1 - 0.5 * s2 / (s2 + 0.33), c2 = 0.45 * s2 / (s2 + 0.09);
  if (bsdf.use_fast_approx) {
    return rho * (wi.z / kPi * (c1 + c2 * std::max(0.0, cos_phi) * std::sin(alpha) * std::tan(beta)));
  }
  const double b = 2 * beta / kPi;
  const double c2_angle = std::sin(alpha) - (cos_phi >= 0 ? 0 : b * b * b);
  const double c3 = 0.125 * s2 / (s2 + 0.09) * sqr(4 * alpha * beta / sqr(kPi));
  const double single = c1 + cos_phi * c2 * c2_angle * std::tan(beta) +
                        (1 - std::abs(cos_phi)) * c3 * std::tan(0.5 * (alpha + beta));
  const double twice = 0.17 * s2 / (s2 + 0.13) * (1 - cos_phi * b * b);
  return (rho * single + rho * rho * twice) * (wi.z / kPi);
}

}  // namespace tachylite::reference
