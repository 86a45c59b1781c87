#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// (1 - w) first + w second, w clamped to [0, 1]; w is also the probability of sampling the second.
std::optional<BsdfSample> sample_bsdf(const BlendBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const BlendBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const BlendBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 null_transmission(const BlendBsdf& bsdf, const ShadingPoint& point, const dvec3& wo);

}  // namespace tachylite::reference
