#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// Our own: `transparency` of the light goes straight through (a null lobe), the rest meets a diffuse
/// surface, the same on both sides.
std::optional<BsdfSample> sample_bsdf(const PaperBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const PaperBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const PaperBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 null_transmission(const PaperBsdf& bsdf, const ShadingPoint& point, const dvec3& wo);

}  // namespace tachylite::reference
