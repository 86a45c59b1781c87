// A rough interface between dielectrics: Walter et al. 2007, eq. 20 and 21, with radiance scaled by 1 / eta^2 on
// transmission. Normals are sampled by their visible distribution, then reflection or refraction by Fresnel.
// Inputs: 0, 1 as the dielectric, 2 constants of interface_from, 3 pair (alpha_u, alpha_v).
#ifndef TACHYLITE_BSDF_ROUGH_DIELECTRIC_GLSL
#define TACHYLITE_BSDF_ROUGH_DIELECTRIC_GLSL
#include "bsdf/dielectric.glsl"
#include "bsdf/microfacet.glsl"

struct RoughDielectricBsdf {
  DielectricBsdf glass;
  Microfacet mf;
  bool smooth_here;
  bool straight;  // refraction hardly bends, so that no float32 half vector tells the slope: a delta lobe
};

// Error of D from rounded directions is about 1.5e-8 / (alpha |eta - 1|).
const float kMinBending = 1e-5;

RoughDielectricBsdf load_rough_dielectric(uint leaf, uint options, vec3 wo, TexturePoint point) {
  vec2 alpha = load_scalar_pair(leaf, 3u, point);
  DielectricBsdf glass = load_dielectric(leaf, wo, point);
  bool straight = has_material(kMaterialDelta) && max(alpha.x, alpha.y) * abs(glass.side.eta - 1.0) < kMinBending;
  return RoughDielectricBsdf(glass, make_microfacet(alpha, options), is_smooth(alpha), straight);
}

// Below, directions are turned over where wo is inside, so that wo.z > 0.

BsdfSample sample_rough_dielectric(RoughDielectricBsdf b, vec3 wo_leaf, vec2 u, float u_lobe) {
  float side = wo_leaf.z < 0.0 ? -1.0 : 1.0;
  vec3 wo = side * wo_leaf;
  vec3 m = sample_visible_normal(b.mf, wo, u);
  float c = max(dot(wo, m), 0.0), gap;
  float reflected = fresnel_dielectric(c, b.glass.side.e, gap);
  bool reflects = u_lobe < reflected;

  vec3 wr = reflect_about(wo, m);
  vec3 wt = refract_by_gap(wo, m, gap, b.glass.side.inv_eta);
  vec3 wi = reflects ? wr : wt;
  vec3 up = reflects ? wr : -wt;
  // Densities of half vectors (Walter et al. 2007, eq. 14 and 17) over those of normals, times dot(wo, m); the
  // denominator dot(wo, m) + eta dot(wi, m) is -gap.
  float jacobian = reflects ? 0.25 : c * abs(dot(wt, m)) * sqr(b.glass.side.eta / gap);
  float chance = reflects ? reflected : 1.0 - reflected;
  float pdf = chance * jacobian * normal_density(b.mf, m) / projected_area(b.mf, wo);
  vec3 color = reflects ? b.glass.reflectance : b.glass.transmittance * sqr(b.glass.side.inv_eta);
  BsdfSample s = BsdfSample(side * wi, color * masking(b.mf, up), pdf, reflects ? 0u : kLobeTransmission,
                            reflects ? 1.0 : b.glass.side.eta);
  if (!(up.z > 0.0 && pdf > 0.0 && wo.z > 0.0)) s = absorbed();
  if (has_material(kMaterialDelta)) {
    if (b.straight && !reflects) {
      s = sample_dielectric(b.glass, wo_leaf, 1.0);
      if (wo.z * wo.z + b.glass.side.e <= 0.0) s = absorbed();  // total reflection
    }
    if (b.smooth_here) s = sample_dielectric(b.glass, wo_leaf, u_lobe);
  }
  return s;
}

BsdfEval eval_rough_dielectric(RoughDielectricBsdf b, vec3 wo_leaf, vec3 wi_leaf) {
  float side = wo_leaf.z < 0.0 ? -1.0 : 1.0;
  vec3 wo = side * wo_leaf, wi = side * wi_leaf;
  bool reflects = wi.z > 0.0;
  vec3 h = wo + (reflects ? 1.0 : b.glass.side.eta) * wi;
  h = h.z < 0.0 ? -h : h;
  float length_h = length(h);
  vec3 m = h / max(length_h, 1e-30);
  vec3 up = reflects ? wi : -wi;

  float c = dot(wo, m), c_i = dot(wi, m);
  float reflected = fresnel_dielectric(max(c, 0.0), b.glass.side.e);
  float jacobian = reflects ? 0.25 : max(c, 0.0) * abs(c_i) * sqr(b.glass.side.eta / max(length_h, 1e-30));
  float chance = reflects ? reflected : 1.0 - reflected;
  float pdf = chance * jacobian * normal_density(b.mf, m) / projected_area(b.mf, wo);
  vec3 color = reflects ? b.glass.reflectance : b.glass.transmittance * sqr(b.glass.side.inv_eta);
  BsdfEval eval = BsdfEval(color * (pdf * masking(b.mf, up)), pdf);
  bool valid = wo.z > 0.0 && up.z > 0.0 && c > 0.0 && (reflects ? c_i > 0.0 : c_i < 0.0);
  if (has_material(kMaterialDelta)) valid = valid && !b.smooth_here && (reflects || !b.straight);
  return valid ? eval : kNoEval;
}

#endif
