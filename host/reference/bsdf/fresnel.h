#pragma once

#include "reference/math.h"

namespace tachylite::reference {

/// Unpolarised reflectance of a dielectric boundary and the refracted ray. eta = index below / index above
/// (where cos_o > 0); cos_o < 0 means that the ray comes from below.
struct DielectricBoundary {
  double reflectance = 1;
  double cos_t = 0;   // of the refracted direction, sign opposite to cos_o; 0 under total internal reflection
  double eta_ti = 1;  // index of the far side / index of the near side, as the ray sees it
};
DielectricBoundary dielectric_boundary(double cos_o, double eta);
inline double fresnel_dielectric(double cos_o, double eta) {
  return dielectric_boundary(cos_o, eta).reflectance;
}

/// Born and Wolf 1999, section 14.4.1: exact reflectance of a conductor of index eta + i k, per channel.
dvec3 fresnel_conductor(double cos_o, const dvec3& eta, const dvec3& k);

/// Mean reflectance of a smooth boundary of relative index eta under diffuse illumination, by the fits that
/// the plugin plastic uses: Egan and Hilgeman 1973 for eta < 1 (0.1 % off at 1/1.5), d'Eon and Irving 2011
/// above.
double fresnel_diffuse_reflectance(double eta);

inline dvec3 reflect(const dvec3& w, const dvec3& m) {
  return 2 * glm::dot(w, m) * m - w;
}
/// Refracts w at the microfacet m; cos_t and eta_ti of the boundary seen under dot(w, m).
inline dvec3 refract(const dvec3& w, const dvec3& m, double cos_t, double eta_ti) {
  return m * (glm::dot(w, m) / eta_ti + cos_t) - w / eta_ti;
}
/// The microfacet that takes wo to wi by reflection (same side) or refraction, m.z > 0 (Walter et al. 2007, "Microfacet
/// Models for Refraction through Rough Surfaces", eqs. 13, 16). eta as of dielectric_boundary.
inline dvec3 half_vector(double eta, const dvec3& wo, const dvec3& wi) {
  const bool reflection = wo.z * wi.z > 0;
  const dvec3 m = glm::normalize(wo + wi * (reflection ? 1 : (wo.z > 0 ? eta : 1 / eta)));
  return m.z < 0 ? -m : m;
}

}  // namespace tachylite::reference
