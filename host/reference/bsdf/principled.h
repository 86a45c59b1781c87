#pragma once

#include "reference/bsdf/bsdf.h"

namespace tachylite::reference {

/// Burley 2012, "Physically-Based Shading at Disney", and 2015, "Extending the Disney BRDF to a BSDF with
/// Integrated Subsurface Scattering", in the form of Mitsuba's plugin. Lobes, with brdf = (1 - metallic)(1 -
/// spec_trans) and bsdf = (1 - metallic) spec_trans:
///   diffuse     front only: brdf c/pi lerp(diffuse + retro-reflection, fake subsurface, flatness)
///   sheen       front only: sheen (1 - metallic) (1 - cos_d)^5 tint; only where the diffuse lobe is (brdf >
///   0) specular    GGX, alpha = roughness^2 / aspect and * aspect (aspect = sqrt(1 - 0.9 anisotropic), both
///   >= 1e-3).
///               Front: F = (1 - metallic)(1 - spec_tint) F_d + metallic Schlick(c) + (1 - metallic)
///               spec_tint Schlick(tinted F0), F_d exact. Back: bsdf F_d.
///   transmission  Walter's, times bsdf sqrt(c)
///   clearcoat   front only: 0.25 clearcoat Schlick(0.04) GTR1(lerp(0.1, 0.001, gloss)) G_GGX(0.25) cos_i;
///   without
///               the 1 / (4 cos_o cos_i) of a microfacet model
/// Schlick's weight takes the angle on the side of lower index.
std::optional<BsdfSample> sample_bsdf(const PrincipledBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(const PrincipledBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(const PrincipledBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);

}  // namespace tachylite::reference
