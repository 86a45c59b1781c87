#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// Smooth boundary, both sides. Reflects with probability F, else refracts; radiance is scaled by 1/eta^2 of
/// the crossing, which cancels on the way back out.
std::optional<BsdfSample> sample_bsdf(const DielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const DielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const DielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
inline bool is_all_delta(const DielectricBsdf&) {
  return true;
}

}  // namespace tachylite::reference
