#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// `front` seen from the front; from behind `back`, with both directions mirrored at the surface (z -> -z).
std::optional<BsdfSample> sample_bsdf(const TwoSidedBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const TwoSidedBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const TwoSidedBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);

}  // namespace tachylite::reference
