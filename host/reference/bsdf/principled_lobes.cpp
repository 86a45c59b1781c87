#include "reference/bsdf/principled_lobes.h"

namespace tachylite::reference {

dvec3 schlick_fresnel(const dvec3& f0, double cos_d, double eta) {
  const double eta_ti = cos_d >= 0 ? eta : 1 / eta;
  double c = std::abs(cos_d);
  if (eta_ti <= 1) c = std::sqrt(std::max(0.0, 1 - (1 - c * c) / sqr(eta_ti)));
  return glm::mix(f0, dvec3(1), schlick_weight(c));
}

Microfacets principled_microfacets(double roughness, double anisotropic) {
  const double aspect = std::sqrt(1 - 0.9 * anisotropic), r2 = sqr(roughness);
  return Microfacets(MicrofacetDistribution::kGgx, std::max(1e-3, r2 / aspect), std::max(1e-3, r2 * aspect));
}

double principled_diffuse(double cos_o, double cos_i, double cos_d, double roughness, double flatness) {
  const double f_o = schlick_weight(cos_o), f_i = schlick_weight(cos_i);
  const double r_r = 2 * roughness * sqr(cos_d);
  const double lambert = (1 - 0.5 * f_o) * (1 - 0.5 * f_i);
  const double retro = r_r * (f_o + f_i + f_o * f_i * (r_r - 1));
  const double ss90 = 0.5 * r_r;
  const double ss = lerp(1, ss90, f_o) * lerp(1, ss90, f_i);
  const double subsurface = 1.25 * (ss * (1 / (cos_o + cos_i) - 0.5) + 0.5);
  return lerp(lambert + retro, subsurface, flatness);
}

dvec3 principled_sheen(const dvec3& base_color, double sheen, double sheen_tint, double cos_d) {
  return glm::mix(dvec3(1), tint_of(base_color), sheen_tint) * (sheen * schlick_weight(std::abs(cos_d)));
}

}  // namespace tachylite::reference
