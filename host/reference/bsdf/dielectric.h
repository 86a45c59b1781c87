#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// Smooth boundary, both sides. Reflects with probability F, else refracts; radiance is scaled by 1/eta^2 of
/// the crossing, which cancels on the way back out. Index-matched and untinted it is a null surface.
std::optional<BsdfSample> sample_bsdf(const DielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const DielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const DielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
inline bool is_all_delta(const DielectricBsdf&) {
  return true;
}

/// |eta - 1| < 1e-6, below which rays do not bend visibly.
bool is_index_matched(const DielectricBsdf& bsdf);
inline dvec3 null_transmission(const DielectricBsdf& bsdf, const ShadingPoint&, const dvec3&) {
  return dvec3(is_index_matched(bsdf) ? 1 : 0);
}

}  // namespace tachylite::reference
