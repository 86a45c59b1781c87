#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// The child in a perturbed shading frame. n' in the local frame (s, t, n):
///   normal map  normalize(2 rgb - 1)
///   bump map    normalize(cross(p_u, p_v)), p_u = dp_du with its part along the shading normal n replaced by
///               dh/du, p_v alike; turned to the side of the geometric normal
/// then s' = normalize(s - n' (n'.s)), s the tangent of the original frame.
/// flip_invalid_normals: where wo.z (wo.n') <= 0, n'.xy is negated. use_shadowing_function: f is multiplied
/// by G(wi) = 2 / (1 + sqrt(1 + a^2 tan^2 theta_i)), a^2 = min(tan^2 theta_n' / 8, 1), theta in the original
/// frame (Estevez, Lecocq and Stein 2019, "A Microfacet-Based Shadowing Function to Solve the Bump Terminator
/// Problem"). f is 0 where wi is on different sides of the two frames; wo is not asked.
std::optional<BsdfSample> sample_bsdf(const NormalMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const NormalMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const NormalMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
std::optional<BsdfSample> sample_bsdf(const BumpMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const BumpMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const BumpMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 null_transmission(const NormalMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo);
dvec3 null_transmission(const BumpMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo);
/// n' in the original frame, for the AOV sh_normal.

}  // namespace tachylite::reference
