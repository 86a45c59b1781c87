#include "reference/bsdf/plastic.h"

#include "reference/bsdf/fresnel.h"

namespace tachylite::reference {
namespace {

double specular_probability(const PlasticBsdf& bsdf, const ShadingPoint& point, double cos_o) {
  const double f = fresnel_dielectric(cos_o, bsdf.eta);
  const double s = f * luminance(point.color(bsdf.specular_reflectance));
  const double d = (1 - f) * luminance(point.color(bsdf.diffuse_reflectance));
  return s + d > 0 ? s / (s + d) : 0;
}

}  // namespace

std::optional<BsdfSample> sample_bsdf(const PlasticBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random) {
  if (wo.z <= 0) return std::nullopt;
  const double p = specular_probability(bsdf, point, wo.z);
  if (random.uniform() < p) {
    const dvec3 weight = point.color(bsdf.specular_reflectance) * (fresnel_dielectric(wo.z, bsdf.eta) / p);
    return BsdfSample{{-wo.x, -wo.y, wo.z}, weight, p, Scattering::kDelta};
  }
  return finish_sample(bsdf, point, wo, sample_cosine_hemisphere(random.uniform2()));
}

double pdf_bsdf(const PlasticBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z <= 0 || wi.z <= 0) return 0;
  return (1 - specular_probability(bsdf, point, wo.z)) * pdf_cosine_hemisphere(wi.z);
}

dvec3 eval_bsdf(const PlasticBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z <= 0 || wi.z <= 0) return dvec3(0);
  const dvec3 rho = point.color(bsdf.diffuse_reflectance);
  const double t_o = 1 - fresnel_dielectric(wo.z, bsdf.eta), t_i = 1 - fresnel_dielectric(wi.z, bsdf.eta);
  const dvec3 k = bsdf.nonlinear ? rho : dvec3(1);
  const dvec3 base = rho / (1.0 - k * fresnel_diffuse_reflectance(1 / bsdf.eta));
  return base * (t_o * t_i / sqr(bsdf.eta) * wi.z / kPi);
}

}  // namespace tachylite::reference
