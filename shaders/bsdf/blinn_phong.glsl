// f = kd / pi + ks (n + 2) / (2 pi) (n_s.h)^n, Blinn 1977, "Models of Light Reflection for Computer Synthesized
// Pictures", with kd + ks <= 1: ks is cut to 1 - kd. A specular weight w, where there is one, makes it
// (1 - w) kd / pi + w ks (...) instead of the sum. One-sided.
// Inputs: 0 kd, 1 ks, 2 pair (exponent n, specular weight), 3 constants (1 where the weight is used, else 0).
#ifndef TACHYLITE_BSDF_BLINN_PHONG_GLSL
#define TACHYLITE_BSDF_BLINN_PHONG_GLSL
#include "base/math.glsl"
#include "base/warp.glsl"
#include "bsdf/input.glsl"
#include "bsdf/lobe.glsl"
#include "bsdf/microfacet.glsl"

struct BlinnPhongBsdf {
  vec3 kd, ks;
  float exponent;
  float specular_probability;
};

BlinnPhongBsdf load_blinn_phong(uint leaf, TexturePoint point) {
  vec3 kd = load_color(leaf, 0u, point), ks = load_color(leaf, 1u, point);
  vec2 pair = load_scalar_pair(leaf, 2u, point);
  bool weighted = load_constants(leaf, 3u).x != 0.0;
  float w = clamp(pair.y, 0.0, 1.0);
  kd = weighted ? (1.0 - w) * kd : kd;
  ks = weighted ? w * ks : min(ks, max(1.0 - kd, vec3(0.0)));
  float d = max_component(kd), s = max_component(ks);
  return BlinnPhongBsdf(kd, ks, max(pair.x, 0.0), s > 0.0 ? s / (s + d) : 0.0);
}

// h.z^n, from the sine, which keeps its digits near the normal.
float power_of_cosine(vec3 h, float n) {
  float s2 = min(dot(h.xy, h.xy), 0.99999994);
  return h.z > 0.0 ? xexp(0.5 * n * xlog1p(-s2)) : 0.0;
}

// Half vectors have the density (n + 1) / (2 pi) (h.z)^n w.r.t. their solid angle.
BsdfEval eval_blinn_phong(BlinnPhongBsdf b, vec3 wo, vec3 wi) {
  vec3 h = normalize(wo + wi);
  float power = kInvTwoPi * power_of_cosine(h, b.exponent);
  float lambert = pdf_cosine_hemisphere(wi.z);
  float pdf_specular = (b.exponent + 1.0) * power / max(4.0 * dot(wo, h), 1e-20);
  BsdfEval eval = BsdfEval(b.kd * lambert + b.ks * ((b.exponent + 2.0) * power * wi.z),
                           mix(lambert, pdf_specular, b.specular_probability));
  bool above = wo.z > 0.0 && wi.z > 0.0;
  return above ? eval : kNoEval;
}

BsdfSample sample_blinn_phong(BlinnPhongBsdf b, vec3 wo, vec2 u, float u_lobe) {
  // (h.z)^(n + 1) is uniform; 1 - h.z^2 = -expm1(2 log(u) / (n + 1)).
  float log_u = xlog1p(-u.y);  // u.y in [0, 1)
  float sin2 = -xexpm1(2.0 * log_u / (b.exponent + 1.0));
  vec3 h = vec3(sqrt(sin2) * cos_sin_turns(u.x), sqrt(max(1.0 - sin2, 0.0)));
  vec3 wi = u_lobe < b.specular_probability ? reflect_about(wo, h) : sample_cosine_hemisphere(u);
  BsdfEval eval = eval_blinn_phong(b, wo, wi);
  BsdfSample s = BsdfSample(wi, eval.f / eval.pdf, eval.pdf, 0u, 1.0);
  if (!(eval.pdf > 0.0)) s = absorbed();
  return s;
}

#endif
