#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// A smooth dielectric coat over a diffuse base, front side only: a delta lobe F, and
///   f = (1 - F(cos_o)) (1 - F(cos_i)) / eta^2 * rho / (1 - k Fdr_int) / pi,  k = rho if nonlinear, else 1,
/// Fdr_int = fresnel_diffuse_reflectance(1 / eta). A sample takes the delta lobe with probability
/// F s / (F s + (1 - F) d), s and d the mean specular and diffuse reflectances; pdf_bsdf includes the
/// complement.
std::optional<BsdfSample> sample_bsdf(const PlasticBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const PlasticBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const PlasticBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);

}  // namespace tachylite::reference
