// A diffuse base under a rough dielectric coat. One-sided. As plastic, with the transmittances of a rough interface,
// tabulated on the host (pack/rough_transmittance) over the cosine: kRoughTransmittanceSize values at i / (size - 1),
// linear in between, as Mitsuba does.
// Inputs: 0, 1, 2 as plastic, 3 constants (alpha, unused...), then rows (T[2i], T[2i+1], T[2i+2], unused).
#ifndef TACHYLITE_BSDF_ROUGH_PLASTIC_GLSL
#define TACHYLITE_BSDF_ROUGH_PLASTIC_GLSL
#include "bsdf/microfacet.glsl"
#include "bsdf/plastic.glsl"

struct RoughPlasticBsdf {
  PlasticBsdf plastic;
  Microfacet mf;
  uint table;          // row
  float transmitted;   // T(wo)
};

float rough_transmittance(uint table, float cos_theta) {
  float x = clamp(cos_theta, 0.0, 1.0) * float(kRoughTransmittanceSize - 1u);
  uint i = min(uint(x), kRoughTransmittanceSize - 2u);
  vec4 row = load_material_floats(table + (i >> 1u));
  vec2 ends = (i & 1u) == 0u ? row.xy : row.yz;
  return mix(ends.x, ends.y, x - float(i));
}

RoughPlasticBsdf load_rough_plastic(uint leaf, uint options, vec3 wo, TexturePoint point) {
  float alpha = load_constants(leaf, 3u).x;
  uint table = leaf + 5u;
  return RoughPlasticBsdf(load_plastic(leaf, point), make_microfacet(vec2(alpha), options), table,
                          rough_transmittance(table, wo.z));
}

BsdfEval eval_rough_plastic(RoughPlasticBsdf b, vec3 wo, vec3 wi) {
  vec3 m = normalize(wo + wi);
  float density = normal_density(b.mf, m);
  float coat = fresnel_dielectric(max(dot(wo, m), 0.0), b.plastic.e) * density * reflection_over_density(b.mf, wo, wi);
  float lambert = pdf_cosine_hemisphere(wi.z);
  float base = b.transmitted * rough_transmittance(b.table, wi.z) * lambert;
  float p = coat_probability(b.plastic, 1.0 - b.transmitted);
  BsdfEval eval = BsdfEval(b.plastic.reflectance * coat + b.plastic.base * base,
                           p * density * reflection_pdf_over_density(b.mf, wo) + (1.0 - p) * lambert);
  bool above = wo.z > 0.0 && wi.z > 0.0;
  return above ? eval : kNoEval;
}

BsdfSample sample_rough_plastic(RoughPlasticBsdf b, vec3 wo, vec2 u, float u_lobe) {
  float p = coat_probability(b.plastic, 1.0 - b.transmitted);
  vec3 wi = u_lobe < p ? reflect_about(wo, sample_reflection_normal(b.mf, wo, u)) : sample_cosine_hemisphere(u);
  BsdfEval eval = eval_rough_plastic(b, wo, wi);
  BsdfSample s = BsdfSample(wi, eval.f / eval.pdf, eval.pdf, 0u, 1.0);
  if (!(eval.pdf > 0.0)) s = absorbed();
  return s;
}

#endif
