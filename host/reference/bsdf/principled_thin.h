#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// Burley 2015, section 5.3 (thin surfaces), in the form of Mitsuba's plugin; the same from both sides. With
/// d = diff_trans / 2:
///   reflection    spec_trans F D G / (4 cos_o), alpha from roughness; F tinted by spec_tint
///   transmission  spec_trans c (1 - F_d) D G / (4 cos_o) mirrored to the other side, no bending; alpha from
///                 roughness (0.65 eta - 0.35)
///   diffuse       (1 - spec_trans)(1 - d) c/pi (as principled, with flatness), and sheen
///   diffuse transmission  (1 - spec_trans) d c/pi
std::optional<BsdfSample> sample_bsdf(const PrincipledThinBsdf& bsdf, const ShadingPoint& point,
                                      const dvec3& wo, Random& random);
double pdf_bsdf(const PrincipledThinBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const PrincipledThinBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);

}  // namespace tachylite::reference
