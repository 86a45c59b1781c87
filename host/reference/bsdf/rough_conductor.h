#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// Walter et al. 2007, eq. 20: f = F D G / (4 |cos_o cos_i|) with the conductor's F at the microfacet; black
/// from behind. alpha_u acts along the frame's s.
std::optional<BsdfSample> sample_bsdf(const RoughConductorBsdf& bsdf, const ShadingPoint& point,
                                      const dvec3& wo, Random& random);
double pdf_bsdf(const RoughConductorBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const RoughConductorBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);

}  // namespace tachylite::reference
