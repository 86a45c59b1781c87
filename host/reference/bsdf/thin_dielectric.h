#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// A thin sheet: all its internal reflections together reflect R' = R + T^2 R / (1 - R^2) = 2 R / (1 + R);
/// the rest goes straight through (a null lobe), tinted once a pass.
std::optional<BsdfSample> sample_bsdf(const ThinDielectricBsdf& bsdf, const ShadingPoint& point,
                                      const dvec3& wo, Random& random);
double pdf_bsdf(const ThinDielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const ThinDielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
inline bool is_all_delta(const ThinDielectricBsdf&) {
  return true;
}
dvec3 null_transmission(const ThinDielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo);

}  // namespace tachylite::reference
