#pragma once

// What principled and principledthin share.

#include "reference/bsdf/microfacet.h"

namespace tachylite::reference {

/// Schlick 1994: (1 - cos)^5.
inline double schlick_weight(double cos_theta) {
  const double m = std::clamp(1 - cos_theta, 0.0, 1.0);
  return sqr(sqr(m)) * m;
}

/// Schlick's Fresnel term from f0, with the angle on the side of lower index; cos_d < 0 means seen from
/// below.
dvec3 schlick_fresnel(const dvec3& f0, double cos_d, double eta);
/// Normal reflectance ((eta - 1) / (eta + 1))^2.
inline double normal_reflectance(double eta) {
  return sqr((eta - 1) / (eta + 1));
}

/// base_color of luminance one; white for black.
inline dvec3 tint_of(const dvec3& base_color) {
  const double l = luminance(base_color);
  return l > 0 ? base_color / l : dvec3(1);
}

/// Burley 2012, section 5.4: alpha = roughness^2, drawn out by aspect = sqrt(1 - 0.9 anisotropic); at least
/// 1e-3.
Microfacets principled_microfacets(double roughness, double anisotropic);

/// Burley 2015, eq. 4 and the fake subsurface term of Burley 2012, without base_color / pi: diffuse with
/// retro-reflection, blended by flatness.
double principled_diffuse(double cos_o, double cos_i, double cos_d, double roughness, double flatness);

/// sheen (1 - cos_d)^5, tinted.
dvec3 principled_sheen(const dvec3& base_color, double sheen, double sheen_tint, double cos_d);

}  // namespace tachylite::reference
