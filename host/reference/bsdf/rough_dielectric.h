#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eqs. 20 and 21, both sides,
/// with the factor 1/eta^2 for radiance on transmission. The normal points to the exterior (ext_ior).
std::optional<BsdfSample> sample_bsdf(const RoughDielectricBsdf& bsdf, const ShadingPoint& point,
                                      const dvec3& wo, Random& random);
double pdf_bsdf(const RoughDielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const RoughDielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);

}  // namespace tachylite::reference
