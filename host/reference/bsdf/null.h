#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// Nothing there: a boundary between media.
std::optional<BsdfSample> sample_bsdf(const NullBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const NullBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const NullBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
inline bool is_all_delta(const NullBsdf&) {
  return true;
}
inline dvec3 null_transmission(const NullBsdf&, const ShadingPoint&, const dvec3&) {
  return dvec3(1);
}

}  // namespace tachylite::reference
