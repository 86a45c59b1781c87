#include "reference/bsdf/principled_thin.h"

#include "reference/bsdf/fresnel.h"
#include "reference/bsdf/principled_lobes.h"

namespace tachylite::reference {
namespace {

/// The parameters at a point, and the probabilities of sampling each lobe.
struct ThinParameters {
  dvec3 base_color;
  double roughness, anisotropic, spec_trans, eta, diff_trans;  // diff_trans halved: in [0, 1]
  double p_reflection, p_transmission, p_diffuse, p_diffuse_transmission;

  ThinParameters(const PrincipledThinBsdf& b, const ShadingPoint& point)
      : base_color(point.color(b.base_color)),
        roughness(point.scalar(b.roughness)),
        anisotropic(point.scalar(b.anisotropic)),
        spec_trans(point.scalar(b.spec_trans)),
        eta(point.scalar(b.eta)),
        diff_trans(0.5 * point.scalar(b.diff_trans)),
        p_reflection(0.5 * spec_trans),
        p_transmission(0.5 * spec_trans),
        p_diffuse((1 - spec_trans) * (1 - diff_trans)),
        p_diffuse_transmission((1 - spec_trans) * diff_trans) {}
  Microfacets reflecting() const { return principled_microfacets(roughness, anisotropic); }
  /// Burley 2015, figure 15: a thin slab of lower index blurs less.
  Microfacets transmitting() const {
    return principled_microfacets((0.65 * eta - 0.35) * roughness, anisotropic);
  }
};

/// Turns the surface so that wo is above it; the model is the same from both sides.
dvec3 flip_to(double cos_o, const dvec3& w) {
  return cos_o < 0 ? -w : w;
}

/// The plugin has no light pass where the back of the facet that mirrors wo to wi's mirror image does not face wi. This
/// is not symmetric in wo and wi.
bool hides_transmission(const dvec3& wo, const dvec3& wi) {
  return glm::dot(wi, wo + dvec3(wi.x, wi.y, -wi.z)) >= 0;
}

}  // namespace

std::optional<BsdfSample> sample_bsdf(const PrincipledThinBsdf& bsdf, const ShadingPoint& point,
                                      const dvec3& wo_given, Random& random) {
  if (wo_given.z == 0) return std::nullopt;
  const dvec3 wo = flip_to(wo_given.z, wo_given);
  const ThinParameters p(bsdf, point);
  const double lobe = random.uniform();
  const dvec2 u = random.uniform2();
  dvec3 wi;
  if (lobe < p.p_reflection) {
    wi = reflect(wo, p.reflecting().sample(wo, u));
    if (wi.z <= 0) return std::nullopt;
  } else if (lobe < p.p_reflection + p.p_transmission) {
    wi = reflect(wo, p.transmitting().sample(wo, u));
    if (wi.z <= 0) return std::nullopt;
    wi.z = -wi.z;
    if (hides_transmission(wo, wi)) return std::nullopt;
  } else {
    wi = sample_cosine_hemisphere(u);
    if (lobe >= 1 - p.p_diffuse_transmission) wi = -wi;
  }
  return finish_sample(bsdf, point, wo_given, flip_to(wo_given.z, wi));
}

double pdf_bsdf(const PrincipledThinBsdf& bsdf, const ShadingPoint& point, const dvec3& wo_given,
                const dvec3& wi_given) {
  if (wo_given.z * wi_given.z == 0) return 0;
  const dvec3 wo = flip_to(wo_given.z, wo_given), wi = flip_to(wo_given.z, wi_given);
  const ThinParameters p(bsdf, point);
  const dvec3 m = glm::normalize(wo + dvec3(wi.x, wi.y, std::abs(wi.z)));
  const double jacobian = 1 / (4 * glm::dot(wo, m));
  if (wi.z > 0) {
    return p.p_reflection * p.reflecting().pdf(wo, m) * jacobian + p.p_diffuse * pdf_cosine_hemisphere(wi.z);
  }
  const double visible = hides_transmission(wo, wi) ? 0 : 1;
  return visible * p.p_transmission * p.transmitting().pdf(wo, m) * jacobian +
         p.p_diffuse_transmission * pdf_cosine_hemisphere(-wi.z);
}

dvec3 eval_bsdf(const PrincipledThinBsdf& bsdf, const ShadingPoint& point, const dvec3& wo_given,
                const dvec3& wi_given) {
  if (wo_given.z * wi_given.z == 0) return dvec3(0);
  const dvec3 wo = flip_to(wo_given.z, wo_given), wi = flip_to(wo_given.z, wi_given);
  const ThinParameters p(bsdf, point);
  const dvec3 wi_mirrored(wi.x, wi.y, std::abs(wi.z));
  const dvec3 m = glm::normalize(wo + wi_mirrored);
  const double cos_d = glm::dot(wo, m), f_d = fresnel_dielectric(cos_d, p.eta);

  if (wi.z < 0) {
    const Microfacets transmitting = p.transmitting();
    const double visible = hides_transmission(wo, wi) ? 0 : 1;
    const double specular =
        visible * p.spec_trans * (1 - f_d) * transmitting.d(m) * transmitting.g(wo, wi_mirrored, m);
    const double diffuse = (1 - p.spec_trans) * p.diff_trans * -wi.z / kPi;
    return p.base_color * (specular / (4 * wo.z) + diffuse);
  }
  const Microfacets reflecting = p.reflecting();
  const dvec3 tinted = schlick_fresnel(tint_of(p.base_color) * normal_reflectance(p.eta), cos_d, p.eta);
  const dvec3 f = glm::mix(dvec3(f_d), tinted, point.scalar(bsdf.spec_tint));
  const dvec3 specular = f * (p.spec_trans * reflecting.d(m) * reflecting.g(wo, wi, m) / (4 * wo.z));
  const double diffuse = principled_diffuse(wo.z, wi.z, cos_d, p.roughness, point.scalar(bsdf.flatness));
  const dvec3 sheen =
      principled_sheen(p.base_color, point.scalar(bsdf.sheen), point.scalar(bsdf.sheen_tint), cos_d);
  return specular + (1 - p.spec_trans) * (1 - p.diff_trans) * wi.z * (p.base_color * (diffuse / kPi) + sheen);
}

}  // namespace tachylite::reference
