#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// Our own: f = kd/pi + ks (n+2)/(2 pi) max(0, h.z)^n, front side only. Where a channel has kd + ks > 1, both
/// are divided by the largest kd + ks of the channels. With specular_weight w: (1-w) kd/pi + w ks (n+2)/(2
/// pi) h.z^n, and no scaling.
std::optional<BsdfSample> sample_bsdf(const BlinnPhongBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const BlinnPhongBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const BlinnPhongBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 albedo_bsdf(const BlinnPhongBsdf& bsdf, const ShadingPoint& point);

}  // namespace tachylite::reference
