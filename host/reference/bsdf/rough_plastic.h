#pragma once

#include "reference/bsdf/microfacet.h"

namespace tachylite::reference {

/// Plastic with a rough coat, front side only: F D G / (4 cos_o cos_i), and
///   f = T(cos_o) T(cos_i) / eta^2 * rho / (1 - k R_int) / pi,  k = rho if nonlinear, else 1.
/// T(mu): fraction of the light at cos = mu from outside that crosses the rough boundary in one scattering,
/// integral of (1 - F) G1(wo) G1(wt) D over the microfacets that refract (no light comes back, so at high
/// alpha T is well below 1 - albedo); interpolated linearly between 64 nodes mu = i / 63. R_int: 2 * (mean
/// over the same 64 nodes of mu * albedo of single scattering from inside, relative index 1 / eta). That mean
/// is no exact integral (it is 1 to 2 % low), but it is what the plugin computes, and images show it.
std::optional<BsdfSample> sample_bsdf(const RoughPlasticBsdf& bsdf, const ShadingPoint& point,
                                      const dvec3& wo, Random& random);
double pdf_bsdf(const RoughPlasticBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const RoughPlasticBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);

RoughPlasticTables make_rough_plastic_tables(const RoughPlasticBsdf& bsdf);
/// Fractions of the light arriving under cos_o that single scattering off (through) a microfacet boundary of
/// index eta returns (lets pass): quadrature over the visible normals, |error| < 1e-3 (a test compares it
/// with an independent integral).
double rough_boundary_reflectance(const Microfacets& microfacets, double eta, double cos_o);
double rough_boundary_transmittance(const Microfacets& microfacets, double eta, double cos_o);

}  // namespace tachylite::reference
