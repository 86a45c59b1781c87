#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// Smooth mirror with the reflectance of a conductor; black from behind.
std::optional<BsdfSample> sample_bsdf(const ConductorBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const ConductorBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const ConductorBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
inline bool is_all_delta(const ConductorBsdf&) {
  return true;
}

}  // namespace tachylite::reference
