// Nori's `microfacet`: f = kd / pi + ks D F G / (4 cos_o cos_i) with Beckmann's D and ks = 1 - max(kd). One-sided.
// Inputs: 0 kd, 1 pair (alpha, -), 2 constants of interface_from.
#ifndef TACHYLITE_BSDF_NORI_MICROFACET_GLSL
#define TACHYLITE_BSDF_NORI_MICROFACET_GLSL
#include "base/warp.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/input.glsl"
#include "bsdf/lobe.glsl"
#include "bsdf/microfacet.glsl"

struct NoriMicrofacetBsdf {
  vec3 kd;
  float ks, e;
  Microfacet mf;
  float coat_probability;
};

// Mitsuba's lower limit of roughness serves where there is no smooth counterpart.
const float kMinMicrofacetAlpha = 1e-4;

NoriMicrofacetBsdf load_nori_microfacet(uint leaf, vec3 wo, TexturePoint point) {
  vec3 kd = load_color(leaf, 0u, point);
  float alpha = max(load_scalar_pair(leaf, 1u, point).x, kMinMicrofacetAlpha);
  float ks = max(1.0 - max_component(kd), 0.0), e = load_constants(leaf, 2u).z;
  float coat = ks * fresnel_dielectric(abs(wo.z), e), base = max_component(kd);
  return NoriMicrofacetBsdf(kd, ks, e, Microfacet(vec2(alpha), false), coat > 0.0 ? coat / (coat + base) : 0.0);
}

BsdfEval eval_nori_microfacet(NoriMicrofacetBsdf b, vec3 wo, vec3 wi) {
  vec3 m = normalize(wo + wi);
  float density = normal_density(b.mf, m);
  float coat = b.ks * fresnel_dielectric(max(dot(wo, m), 0.0), b.e) * density * reflection_over_density(b.mf, wo, wi);
  float lambert = pdf_cosine_hemisphere(wi.z);
  BsdfEval eval = BsdfEval(b.kd * lambert + coat,
                           mix(lambert, density * reflection_pdf_over_density(b.mf, wo), b.coat_probability));
  bool above = wo.z > 0.0 && wi.z > 0.0;
  return above ? eval : kNoEval;
}

BsdfSample sample_nori_microfacet(NoriMicrofacetBsdf b, vec3 wo, vec2 u, float u_lobe) {
  vec3 wi = u_lobe < b.coat_probability ? reflect_about(wo, sample_reflection_normal(b.mf, wo, u))
                                        : sample_cosine_hemisphere(u);
  BsdfEval eval = eval_nori_microfacet(b, wo, wi);
  BsdfSample s = BsdfSample(wi, eval.f / eval.pdf, eval.pdf, 0u, 1.0);
  if (!(eval.pdf > 0.0)) s = absorbed();
  return s;
}

#endif
