#include "reference/bsdf/rough_plastic.h"

#include <array>

#include "reference/bsdf/fresnel.h"
#include "reference/bsdf/microfacet.h"

namespace tachylite::reference {
namespace {

double transmittance(const RoughPlasticTables& tables, double mu) {
  const auto& t = tables.transmittance;
  const double x = std::clamp(mu, 0.0, 1.0) * static_cast<double>(t.size() - 1);
  const size_t i = std::min(static_cast<size_t>(x), t.size() - 2);
  return lerp(t[i], t[i + 1], x - static_cast<double>(i));
}

Microfacets coat(const RoughPlasticBsdf& bsdf, const ShadingPoint& point) {
  const double alpha = point.scalar(bsdf.roughness.alpha_u);
  return Microfacets(bsdf.roughness.distribution, alpha, alpha);
}

double specular_probability(const RoughPlasticBsdf& bsdf, const ShadingPoint& point, double cos_o) {
  const double t = transmittance(point.materials.rough_plastic(bsdf), cos_o);
  const double s = (1 - t) * luminance(point.color(bsdf.specular_reflectance));
  const double d = t * luminance(point.color(bsdf.diffuse_reflectance));
  return s + d > 0 ? s / (s + d) : 0;
}

/// Mean of value(m) over the microfacets seen from wo: the midpoint rule over the two numbers that choose them, which
/// go as s^3 (10 - 15 s + 6 s^2): the steps are short at both ends, where the long tails of GGX lie.
template <class Value>
double mean_over_visible_normals(const Microfacets& microfacets, const dvec3& wo, const Value& value) {
  constexpr int kSteps = 64;
  std::array<double, kSteps> u, weights;
  for (size_t i = 0; i < kSteps; ++i) {
    const double s = (static_cast<double>(i) + 0.5) / kSteps;
    u[i] = s * s * s * (10 - 15 * s + 6 * s * s);
    weights[i] = 30 * sqr(s * (1 - s)) / kSteps;
  }
  double sum = 0;
  for (size_t i = 0; i < kSteps; ++i)
    for (size_t j = 0; j < kSteps; ++j) sum += weights[i] * weights[j] * value(microfacets.sample(wo, {u[i], u[j]}));
  return sum;
}

}  // namespace

double rough_boundary_reflectance(const Microfacets& microfacets, double eta, double cos_o) {
  const dvec3 wo(std::sqrt(std::max(0.0, 1 - sqr(cos_o))), 0, cos_o);
  return mean_over_visible_normals(microfacets, wo, [&](const dvec3& m) {
    const dvec3 wi = reflect(wo, m);
    return wi.z > 0 ? fresnel_dielectric(glm::dot(wo, m), eta) * microfacets.g1(wi, m) : 0;
  });
}

double rough_boundary_transmittance(const Microfacets& microfacets, double eta, double cos_o) {
  const dvec3 wo(std::sqrt(std::max(0.0, 1 - sqr(cos_o))), 0, cos_o);
  return mean_over_visible_normals(microfacets, wo, [&](const dvec3& m) {
    const DielectricBoundary boundary = dielectric_boundary(glm::dot(wo, m), eta);
    const dvec3 wt = refract(wo, m, boundary.cos_t, boundary.eta_ti);
    return wt.z < 0 ? (1 - boundary.reflectance) * microfacets.g1(wt, m) : 0;
  });
}

RoughPlasticTables make_rough_plastic_tables(const RoughPlasticBsdf& bsdf) {
  RoughPlasticTables tables;
  const size_t n = tables.transmittance.size();
  const double alpha = bsdf.roughness.alpha_u.value;
  const Microfacets microfacets(bsdf.roughness.distribution, alpha, alpha);
  for (size_t i = 0; i < n; ++i) {
    const double mu = std::max(1e-6, static_cast<double>(i) / static_cast<double>(n - 1));
    tables.transmittance[i] = rough_boundary_transmittance(microfacets, bsdf.eta, mu);
    tables.internal_reflectance +=
        2 * mu * rough_boundary_reflectance(microfacets, 1 / bsdf.eta, mu) / static_cast<double>(n);
  }
  if (!bsdf.keeps_light_inside) return tables;
  double leaves = 0;  // of diffuse light from inside; midpoint rule
  for (size_t i = 0; i < n; ++i) {
    const double mu = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    leaves += 2 * mu * rough_boundary_transmittance(microfacets, 1 / bsdf.eta, mu) / static_cast<double>(n);
  }
  tables.internal_reflectance = 1 - leaves;
  return tables;
}

std::optional<BsdfSample> sample_bsdf(const RoughPlasticBsdf& bsdf, const ShadingPoint& point,
                                      const dvec3& wo, Random& random) {
  if (wo.z <= 0) return std::nullopt;
  const bool specular = random.uniform() < specular_probability(bsdf, point, wo.z);
  const dvec2 u = random.uniform2();
  const dvec3 wi = specular ? reflect(wo, coat(bsdf, point).sample(wo, u)) : sample_cosine_hemisphere(u);
  return finish_sample(bsdf, point, wo, wi);
}

double pdf_bsdf(const RoughPlasticBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z <= 0 || wi.z <= 0) return 0;
  const dvec3 m = glm::normalize(wo + wi);
  const double p = specular_probability(bsdf, point, wo.z);
  return lerp(pdf_cosine_hemisphere(wi.z), coat(bsdf, point).pdf(wo, m) / (4 * glm::dot(wo, m)), p);
}

dvec3 eval_bsdf(const RoughPlasticBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z <= 0 || wi.z <= 0) return dvec3(0);
  const RoughPlasticTables& tables = point.materials.rough_plastic(bsdf);
  const dvec3 m = glm::normalize(wo + wi);
  const Microfacets microfacets = coat(bsdf, point);
  const double f = fresnel_dielectric(glm::dot(wo, m), bsdf.eta);
  const double specular = f * microfacets.d(m) * microfacets.g(wo, wi, m) / (4 * wo.z);
  const dvec3 rho = point.color(bsdf.diffuse_reflectance);
  const dvec3 k = bsdf.nonlinear ? rho : dvec3(1);
  const dvec3 base = rho / (1.0 - k * tables.internal_reflectance);
  const double t = transmittance(tables, wo.z) * transmittance(tables, wi.z);
  return point.color(bsdf.specular_reflectance) * specular + base * (t / sqr(bsdf.eta) * wi.z / kPi);
}

}  // namespace tachylite::reference
