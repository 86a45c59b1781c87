// Oren and Nayar 1994, "Generalization of Lambert's Reflectance Model", as Mitsuba 0.6 evaluates it: with
// interreflection (eq. 30 and 31), or (constant 0 of row 2) the qualitative model without (eq. 34). One-sided.
// Inputs: 0 reflectance, 1 pair (alpha, -): sigma = alpha / sqrt(2), 2 constants (use_fast_approx, unused...).
#ifndef TACHYLITE_BSDF_ROUGH_DIFFUSE_GLSL
#define TACHYLITE_BSDF_ROUGH_DIFFUSE_GLSL
#include "base/math.glsl"
#include "base/warp.glsl"
#include "bsdf/input.glsl"
#include "bsdf/lobe.glsl"

struct RoughDiffuseBsdf {
  vec3 reflectance;
  float sigma2;
  bool fast;
};

RoughDiffuseBsdf load_rough_diffuse(uint leaf, TexturePoint point) {
  float alpha = load_scalar_pair(leaf, 1u, point).x;
  return RoughDiffuseBsdf(load_color(leaf, 0u, point), 0.5 * alpha * alpha, load_constants(leaf, 2u).x != 0.0);
}

// pi f, for wo and wi above the surface.
vec3 oren_nayar(RoughDiffuseBsdf b, vec3 wo, vec3 wi) {
  float sin_o = length(wo.xy), sin_i = length(wi.xy);
  float cos_phi = sin_o > 1e-4 && sin_i > 1e-4 ? dot(wo.xy, wi.xy) / (sin_o * sin_i) : 0.0;
  bool i_steeper = wi.z > wo.z;  // alpha: the larger angle to the normal, beta: the smaller
  float sin_a = i_steeper ? sin_o : sin_i, cos_a = i_steeper ? wo.z : wi.z;
  float sin_b = i_steeper ? sin_i : sin_o, cos_b = i_steeper ? wi.z : wo.z;
  float tan_b = sin_b / cos_b;
  float c1 = 1.0 - 0.5 * b.sigma2 / (b.sigma2 + 0.33);
  float ratio = b.sigma2 / (b.sigma2 + 0.09);
  float c2 = 0.45 * ratio;
  vec3 fast = b.reflectance * (c1 + c2 * max(cos_phi, 0.0) * sin_a * tan_b);

  float angle_a = xacos(cos_a), angle_b = xacos(cos_b);
  float beta = 2.0 * kInvPi * angle_b;
  float c3 = 0.125 * ratio * sqr(4.0 * kInvPi * kInvPi * angle_a * angle_b);
  float c4 = 0.17 * b.sigma2 / (b.sigma2 + 0.13);
  float c2_phi = c2 * (cos_phi > 0.0 ? sin_a : sin_a - beta * beta * beta);
  float tan_half = (sin_a + sin_b) / (cos_a + cos_b);  // of (alpha + beta) / 2
  float once = c1 + cos_phi * c2_phi * tan_b + (1.0 - abs(cos_phi)) * c3 * tan_half;
  float twice = c4 * (1.0 - cos_phi * beta * beta);
  vec3 full = b.reflectance * once + b.reflectance * b.reflectance * twice;
  return b.fast ? fast : full;
}

BsdfEval eval_rough_diffuse(RoughDiffuseBsdf b, vec3 wo, vec3 wi) {
  float pdf = pdf_cosine_hemisphere(wi.z);
  BsdfEval eval = BsdfEval(oren_nayar(b, wo, wi) * pdf, pdf);
  bool above = wo.z > 0.0 && wi.z > 0.0;
  return above ? eval : kNoEval;
}

BsdfSample sample_rough_diffuse(RoughDiffuseBsdf b, vec3 wo, vec2 u) {
  vec3 wi = sample_cosine_hemisphere(u);
  BsdfSample s = BsdfSample(wi, oren_nayar(b, wo, wi), pdf_cosine_hemisphere(wi.z), 0u, 1.0);
  bool above = wo.z > 0.0 && wi.z > 0.0;
  if (!above) s = absorbed();
  return s;
}

#endif
