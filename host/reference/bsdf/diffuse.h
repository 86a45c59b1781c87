#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// f = reflectance / pi, seen and lit from the side of the shading normal only.
std::optional<BsdfSample> sample_bsdf(const DiffuseBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const DiffuseBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const DiffuseBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);

}  // namespace tachylite::reference
