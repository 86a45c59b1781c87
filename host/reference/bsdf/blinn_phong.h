#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// Our own: f = kd/pi + ks (n+2)/(2 pi) max(0, h.z)^n, front side only, ks cut to at most 1 - kd in each
/// channel. With specular_weight w: (1-w) kd/pi + w ks (n+2)/(2 pi) h.z^n, and no cut. Note that (n+2)/(2 pi)
/// normalises the density of h, not f: the specular part reflects up to 4 ks.
std::optional<BsdfSample> sample_bsdf(const BlinnPhongBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const BlinnPhongBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const BlinnPhongBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);

}  // namespace tachylite::reference
