#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// Oren and Nayar 1994, "Generalization of Lambert's Reflectance Model", eqs. 29-31 with interreflection, or
/// their qualitative model (eq. 30) with use_fast_approx. Front side only. The standard deviation of the
/// slope angles is sigma = alpha / sqrt(2), as in the plugin roughdiffuse of Mitsuba 0.6.
std::optional<BsdfSample> sample_bsdf(const RoughDiffuseBsdf& bsdf, const ShadingPoint& point,
                                      const dvec3& wo, Random& random);
double pdf_bsdf(const RoughDiffuseBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const RoughDiffuseBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);

}  // namespace tachylite::reference
