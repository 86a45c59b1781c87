#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// Our own, Nori's `microfacet`, front side only: f = kd/pi + (1 - max kd) F D G / (4 cos_o cos_i), Beckmann
/// with separable G, F of the dielectric int_ior / ext_ior.
std::optional<BsdfSample> sample_bsdf(const MicrofacetBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const MicrofacetBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const MicrofacetBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);

}  // namespace tachylite::reference
