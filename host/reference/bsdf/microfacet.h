#pragma once

// Microfacet distributions, anisotropic, in the local frame: alpha_u along x, alpha_v along y, used as given
// (not squared), clamped to at least 1e-4. Separable masking: G = G1(wo) G1(wi), as Mitsuba has it.
//   Beckmann  D = exp(-q) / (pi au av mz^4),  q = ((mx/au)^2 + (my/av)^2) / mz^2
//   GGX       D = 1 / (pi au av ((mx/au)^2 + (my/av)^2 + mz^2)^2)
// G1 is exact for both (Heitz 2014, "Understanding the Masking-Shadowing Function", eq. 72 and 66); Mitsuba's
// Beckmann G1 is a rational fit that differs by up to 0.35 %.

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

class Microfacets {
 public:
  Microfacets(MicrofacetDistribution distribution, double alpha_u, double alpha_v)
      : distribution_(distribution), alpha_u_(std::max(alpha_u, 1e-4)), alpha_v_(std::max(alpha_v, 1e-4)) {}
  Microfacets(const Roughness& roughness, const ShadingPoint& point)
      : Microfacets(roughness.distribution, point.scalar(roughness.alpha_u),
                    point.scalar(roughness.alpha_v)) {}

  /// A normal m visible from w (on either side; m.z > 0): Heitz 2018, "Sampling the GGX Distribution of
  /// Visible Normals"; Heitz and d'Eon 2014, "Importance Sampling Microfacet-Based BSDFs with the
  /// Distribution of Visible Normals", for Beckmann.
  dvec3 sample(const dvec3& w, const dvec2& u) const;
  /// Density of `sample` w.r.t. solid angle of m: G1 D (w.m) / |w.z|.
  double pdf(const dvec3& w, const dvec3& m) const;

  double d(const dvec3& m) const {
    return distribution_ == MicrofacetDistribution::kGgx ? ggx_d(m) : beckmann_d(m);
  }
  /// Fraction of the facets m that w sees; 0 where w is behind m but not behind the surface, or the reverse.
  double g1(const dvec3& w, const dvec3& m) const;
  double g(const dvec3& wo, const dvec3& wi, const dvec3& m) const { return g1(wo, m) * g1(wi, m); }

 private:
  dvec3 sample_ggx(const dvec3& w, const dvec2& u) const;       // unit roughness, w.z >= 0
  dvec3 sample_beckmann(const dvec3& w, const dvec2& u) const;  // the same; the normal's z is 1
  double ggx_d(const dvec3& m) const;
  double beckmann_d(const dvec3& m) const;
  double ggx_lambda(const dvec3& w) const;
  double beckmann_lambda(const dvec3& w) const;

  MicrofacetDistribution distribution_;
  double alpha_u_, alpha_v_;
};

}  // namespace tachylite::reference
