// Mitsuba's `principledthin` (disney.glsl): a sheet without thickness that reflects and transmits, both diffusely and
// by GGX lobes. The same from both sides.
// Inputs: 0 base_color; 1-2 quad (roughness, anisotropic, spec_trans, eta); 3-4 quad (spec_tint, sheen, sheen_tint,
// flatness); 5 pair (diff_trans, -), 0..2; 6 constants: sampling rates (specular reflection, specular transmission,
// diffuse reflection, diffuse transmission).
#ifndef TACHYLITE_BSDF_PRINCIPLED_THIN_GLSL
#define TACHYLITE_BSDF_PRINCIPLED_THIN_GLSL
#include "base/warp.glsl"
#include "bsdf/disney.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/input.glsl"
#include "bsdf/lobe.glsl"

struct PrincipledThinBsdf {
  vec3 base_color;
  float roughness, spec_trans, eta, spec_tint, sheen, sheen_tint, flatness, diff_trans;
  Microfacet reflection, transmission;
  vec4 probability;  // in the order of the sampling rates
};

float thin_eta_e(float eta) { return (eta - 1.0) * (eta + 1.0); }

PrincipledThinBsdf load_principled_thin(uint leaf, vec3 wo, TexturePoint point) {
  PrincipledThinBsdf b;
  b.base_color = load_color(leaf, 0u, point);
  vec4 first = load_scalar_quad(leaf, 1u, point), second = load_scalar_quad(leaf, 3u, point);
  b.roughness = first.x;
  b.spec_trans = first.z;
  b.eta = first.w;
  b.spec_tint = second.x;
  b.sheen = second.y;
  b.sheen_tint = second.z;
  b.flatness = second.w;
  b.diff_trans = 0.5 * load_scalar_pair(leaf, 5u, point).x;
  b.reflection = disney_microfacet(first.x, first.y);
  b.transmission = disney_microfacet((0.65 * b.eta - 0.35) * first.x, first.y);  // Burley 2015, figure 15

  float reflected = fresnel_dielectric(abs(wo.z), thin_eta_e(b.eta));
  float base = mean(b.base_color), rest = 1.0 - b.spec_trans;
  vec4 weights = load_constants(leaf, 6u) *
                 vec4(b.spec_trans * max(reflected, 0.1), b.spec_trans * (1.0 - reflected) * base,
                      rest * (1.0 - b.diff_trans) * (base + 0.2 * b.sheen), rest * b.diff_trans * base);
  float sum = weights.x + weights.y + weights.z + weights.w;
  b.probability = sum > 0.0 ? weights / sum : vec4(0.0, 0.0, 1.0, 0.0);
  return b;
}

// Both lobes live on the side of wo; transmission mirrors wi.
BsdfEval eval_principled_thin(PrincipledThinBsdf b, vec3 wo_leaf, vec3 wi_leaf) {
  float turn = wo_leaf.z < 0.0 ? -1.0 : 1.0;
  vec3 wo = turn * wo_leaf, wi = turn * wi_leaf;
  bool reflects = wi.z > 0.0;
  vec3 up = vec3(wi.xy, abs(wi.z));
  vec3 h = normalize(wo + up);
  float c = dot(wo, h);
  // Of the mirrored direction Mitsuba asks that the facet's other side faces it.
  bool facet_visible = c > 0.0 && (reflects || dot(wi, h) < 0.0);
  float reflected = fresnel_dielectric(max(c, 0.0), thin_eta_e(b.eta));

  Microfacet mf = Microfacet(reflects ? b.reflection.alpha : b.transmission.alpha, true);
  float density = facet_visible ? 0.25 * normal_density(mf, h) / projected_area(mf, wo) : 0.0;
  vec3 tinted = schlick(tint_of(b.base_color) * schlick_r0(b.eta), c, b.eta);
  vec3 color = reflects ? mix(vec3(reflected), tinted, b.spec_tint) : b.base_color * (1.0 - reflected);
  vec3 f = color * (b.spec_trans * density * masking(mf, up));

  float lambert = pdf_cosine_hemisphere(up.z), rest = 1.0 - b.spec_trans;
  vec3 diffuse = b.base_color * disney_diffuse(wo.z, up.z, c, b.roughness, b.flatness) +
                 kPi * disney_sheen(b.base_color, b.sheen, b.sheen_tint, c);
  f += (reflects ? (1.0 - b.diff_trans) * diffuse : b.diff_trans * b.base_color) * (rest * lambert);
  float pdf = reflects ? b.probability.x * density + b.probability.z * lambert
                       : b.probability.y * density + b.probability.w * lambert;
  bool valid = wo.z > 0.0 && up.z > 0.0;
  return valid ? BsdfEval(f, pdf) : kNoEval;
}

BsdfSample sample_principled_thin(PrincipledThinBsdf b, vec3 wo_leaf, vec2 u, float u_lobe) {
  float turn = wo_leaf.z < 0.0 ? -1.0 : 1.0;
  vec3 wo = turn * wo_leaf;
  vec3 sums = vec3(b.probability.x, b.probability.x + b.probability.y,
                   b.probability.x + b.probability.y + b.probability.z);
  bool specular = u_lobe < sums.y;
  bool reflects = u_lobe < sums.x || (u_lobe >= sums.y && (u_lobe < sums.z || b.probability.w == 0.0));
  vec2 alpha = reflects ? b.reflection.alpha : b.transmission.alpha;
  vec3 m = sample_visible_ggx(alpha, wo, u, 1.0);
  vec3 up = specular ? reflect_about(wo, m) : sample_cosine_hemisphere(u);
  vec3 wi_leaf = turn * vec3(up.xy, reflects ? up.z : -up.z);
  BsdfEval eval = eval_principled_thin(b, wo_leaf, wi_leaf);
  BsdfSample s = BsdfSample(wi_leaf, eval.f / eval.pdf, eval.pdf, reflects ? 0u : kLobeTransmission, 1.0);
  // What eval_principled_thin does not count as this lobe must not be sampled by it.
  bool hidden = specular && !reflects && up.x * m.x + up.y * m.y - up.z * m.z >= 0.0;
  if (hidden || !(eval.pdf > 0.0 && up.z > 0.0)) s = absorbed();
  return s;
}

#endif
