#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// The child with probability opacity (clamped to [0, 1]), else straight through.
std::optional<BsdfSample> sample_bsdf(const MaskBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const MaskBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const MaskBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 null_transmission(const MaskBsdf& bsdf, const ShadingPoint& point, const dvec3& wo);

}  // namespace tachylite::reference
