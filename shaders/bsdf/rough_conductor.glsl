// A rough metal: Cook and Torrance 1982 with the distributions of microfacet.glsl. One-sided.
// Inputs: 0 eta, 1 k, 2 specular reflectance (as the smooth conductor), 3 pair (alpha_u, alpha_v).
#ifndef TACHYLITE_BSDF_ROUGH_CONDUCTOR_GLSL
#define TACHYLITE_BSDF_ROUGH_CONDUCTOR_GLSL
#include "bsdf/conductor.glsl"
#include "bsdf/microfacet.glsl"

struct RoughConductorBsdf {
  ConductorBsdf metal;
  Microfacet mf;
  bool smooth_here;
};

RoughConductorBsdf load_rough_conductor(uint leaf, uint options, TexturePoint point) {
  vec2 alpha = load_scalar_pair(leaf, 3u, point);
  return RoughConductorBsdf(load_conductor(leaf, point), make_microfacet(alpha, options), is_smooth(alpha));
}

BsdfSample sample_rough_conductor(RoughConductorBsdf b, vec3 wo, vec2 u) {
  vec3 m = sample_reflection_normal(b.mf, wo, u);
  vec3 wi = reflect_about(wo, m);
  float ratio = reflection_over_density(b.mf, wo, wi) / reflection_pdf_over_density(b.mf, wo);
  vec3 f = b.metal.reflectance * fresnel_conductor(max(dot(wo, m), 0.0), b.metal.eta, b.metal.k);
  float pdf = normal_density(b.mf, m) * reflection_pdf_over_density(b.mf, wo);
  BsdfSample s = BsdfSample(wi, f * ratio, pdf, 0u, 1.0);
  if (!(wo.z > 0.0 && wi.z > 0.0 && pdf > 0.0)) s = absorbed();
  if (b.smooth_here) s = sample_conductor(b.metal, wo);
  return s;
}

BsdfEval eval_rough_conductor(RoughConductorBsdf b, vec3 wo, vec3 wi) {
  vec3 m = normalize(wo + wi);
  float density = normal_density(b.mf, m);
  vec3 f = b.metal.reflectance * fresnel_conductor(max(dot(wo, m), 0.0), b.metal.eta, b.metal.k);
  BsdfEval eval = BsdfEval(f * (density * reflection_over_density(b.mf, wo, wi)),
                           density * reflection_pdf_over_density(b.mf, wo));
  bool inside = wo.z > 0.0 && wi.z > 0.0 && !b.smooth_here;
  return inside ? eval : kNoEval;
}

#endif
