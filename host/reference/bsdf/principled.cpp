#include "reference/bsdf/principled.h"

#include "reference/bsdf/fresnel.h"
#include "reference/bsdf/principled_lobes.h"

namespace tachylite::reference {
namespace {

/// The parameters at a point, and the probabilities of sampling each lobe from the side of wo.
struct Parameters {
  dvec3 base_color;
  double roughness, anisotropic, metallic, spec_trans, spec_tint, clearcoat, clearcoat_gloss;
  double brdf, bsdf;  // weights of the opaque and the transparent dielectric
  double p_diffuse, p_specular, p_clearcoat;

  Parameters(const PrincipledBsdf& b, const ShadingPoint& point, bool front)
      : base_color(point.color(b.base_color)),
        roughness(point.scalar(b.roughness)),
        anisotropic(point.scalar(b.anisotropic)),
        metallic(point.scalar(b.metallic)),
        spec_trans(point.scalar(b.spec_trans)),
        spec_tint(point.scalar(b.spec_tint)),
        clearcoat(point.scalar(b.clearcoat)),
        clearcoat_gloss(point.scalar(b.clearcoat_gloss)),
        brdf((1 - metallic) * (1 - spec_trans)),
        bsdf((1 - metallic) * spec_trans) {
    const double diffuse = front ? brdf : 0, specular = front ? 1 : bsdf, coat = front ? 0.25 * clearcoat : 0;
    const double sum = diffuse + specular + coat;
    p_diffuse = sum > 0 ? diffuse / sum : 0;
    p_specular = sum > 0 ? specular / sum : 0;
    p_clearcoat = sum > 0 ? coat / sum : 0;
  }
  Microfacets microfacets() const { return principled_microfacets(roughness, anisotropic); }
  double clearcoat_alpha() const { return lerp(0.1, 0.001, clearcoat_gloss); }
};

/// Burley 2012, eq. 4 (generalised Trowbridge-Reitz, gamma = 1), normalised: D m.z is a density.
double gtr1_d(double alpha, const dvec3& m) {
  const double a2 = sqr(alpha);
  return (a2 - 1) / (kPi * std::log(a2) * (1 + (a2 - 1) * sqr(m.z)));
}

dvec3 sample_gtr1(double alpha, const dvec2& u) {
  const double a2 = sqr(alpha);
  const double cos2 = (1 - std::pow(a2, 1 - u.x)) / (1 - a2);
  const double sine = std::sqrt(std::max(0.0, 1 - cos2)), phi = 2 * kPi * u.y;
  return {sine * std::cos(phi), sine * std::sin(phi), std::sqrt(std::max(0.0, cos2))};
}

/// How the specular lobe splits between reflection and refraction when it is sampled.
double reflection_probability(const Parameters& p, double fresnel, bool front) {
  // From behind only the fraction bsdf of the surface is there at all, so both parts have it.
  const double reflected = front ? lerp(fresnel, 1, p.metallic) : fresnel;
  const double refracted = (1 - fresnel) * (front ? p.bsdf : 1);
  return reflected + refracted > 0 ? reflected / (reflected + refracted) : 1;
}

}  // namespace

std::optional<BsdfSample> sample_bsdf(const PrincipledBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random) {
  if (wo.z == 0) return std::nullopt;
  const bool front = wo.z > 0;
  const Parameters p(bsdf, point, front);
  const double lobe = random.uniform();
  const dvec2 u = random.uniform2();
  if (lobe < p.p_diffuse) return finish_sample(bsdf, point, wo, sample_cosine_hemisphere(u));
  if (lobe < p.p_diffuse + p.p_clearcoat) {
    return finish_sample(bsdf, point, wo, reflect(wo, sample_gtr1(p.clearcoat_alpha(), u)));
  }
  const dvec3 m = p.microfacets().sample(wo, u);
  const DielectricBoundary boundary = dielectric_boundary(glm::dot(wo, m), bsdf.eta);
  const bool reflection = random.uniform() < reflection_probability(p, boundary.reflectance, front);
  const dvec3 wi = reflection ? reflect(wo, m) : refract(wo, m, boundary.cos_t, boundary.eta_ti);
  if ((wo.z * wi.z > 0) != reflection) return std::nullopt;
  return finish_sample(bsdf, point, wo, wi, reflection ? 1 : boundary.eta_ti);
}

double pdf_bsdf(const PrincipledBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z * wi.z == 0) return 0;
  const bool front = wo.z > 0, reflection = wo.z * wi.z > 0;
  const Parameters p(bsdf, point, front);
  const dvec3 m = half_vector(bsdf.eta, wo, wi);
  const double mo = glm::dot(wo, m), mi = glm::dot(wi, m);
  const DielectricBoundary boundary = dielectric_boundary(mo, bsdf.eta);
  const double reflect_share = reflection_probability(p, boundary.reflectance, front);
  double pdf = 0;
  if (mo * wo.z > 0 && mi * wi.z > 0) {
    const double pdf_m = p.microfacets().pdf(wo, m), eta = boundary.eta_ti;
    pdf += p.p_specular * pdf_m *
           (reflection ? reflect_share / (4 * std::abs(mi))
                       : (1 - reflect_share) * sqr(eta) * std::abs(mi) / sqr(mo + eta * mi));
  }
  if (front && reflection) {
    pdf += p.p_diffuse * pdf_cosine_hemisphere(wi.z);
    if (mi > 0) pdf += p.p_clearcoat * gtr1_d(p.clearcoat_alpha(), m) * m.z / (4 * mi);
  }
  return pdf;
}

dvec3 eval_bsdf(const PrincipledBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  if (wo.z * wi.z == 0) return dvec3(0);
  const bool front = wo.z > 0, reflection = wo.z * wi.z > 0;
  const Parameters p(bsdf, point, front);
  const dvec3 m = half_vector(bsdf.eta, wo, wi);
  const double mo = glm::dot(wo, m), mi = glm::dot(wi, m);
  const bool sides_agree = mo * wo.z > 0 && mi * wi.z > 0;
  const DielectricBoundary boundary = dielectric_boundary(mo, bsdf.eta);
  const double f_d = boundary.reflectance;
  const Microfacets microfacets = p.microfacets();
  const double dg = sides_agree ? microfacets.d(m) * microfacets.g(wo, wi, m) : 0;

  if (!reflection) {
    const double eta = boundary.eta_ti;
    return glm::sqrt(p.base_color) *
           (p.bsdf * (1 - f_d) * dg * std::abs(mo * mi / wo.z) / sqr(mo + eta * mi));
  }
  if (!front) return dvec3(p.bsdf * f_d * dg / (4 * std::abs(wo.z)));

  // Specular.
  const dvec3 tinted = tint_of(p.base_color) * normal_reflectance(bsdf.eta);
  const dvec3 f = (1 - p.metallic) * (1 - p.spec_tint) * f_d +
                  p.metallic * schlick_fresnel(p.base_color, mo, bsdf.eta) +
                  (1 - p.metallic) * p.spec_tint * schlick_fresnel(tinted, mo, bsdf.eta);
  dvec3 value = f * (dg / (4 * wo.z));

  // Clearcoat.
  if (p.clearcoat > 0 && sides_agree) {
    const Microfacets masking(MicrofacetDistribution::kGgx, 0.25, 0.25);
    value += 0.25 * p.clearcoat * schlick_fresnel(dvec3(0.04), mo, bsdf.eta) *
             gtr1_d(p.clearcoat_alpha(), m) * masking.g(wo, wi, m) * wi.z;
  }

  // Diffuse and sheen.
  if (p.brdf > 0) {
    const double diffuse = principled_diffuse(wo.z, wi.z, mi, p.roughness, point.scalar(bsdf.flatness));
    value += p.base_color * (p.brdf * diffuse * wi.z / kPi);
    value += (1 - p.metallic) * wi.z *
             principled_sheen(p.base_color, point.scalar(bsdf.sheen), point.scalar(bsdf.sheen_tint), mi);
  }
  return value;
}

}  // namespace tachylite::reference
