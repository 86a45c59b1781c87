// Lambert: f = reflectance / pi above the surface. One-sided. Input 0: reflectance.
#ifndef TACHYLITE_BSDF_DIFFUSE_GLSL
#define TACHYLITE_BSDF_DIFFUSE_GLSL
#include "base/warp.glsl"
#include "bsdf/input.glsl"
#include "bsdf/lobe.glsl"

struct DiffuseBsdf { vec3 reflectance; };

DiffuseBsdf load_diffuse(uint leaf, TexturePoint point) { return DiffuseBsdf(load_color(leaf, 0u, point)); }

BsdfSample sample_diffuse(DiffuseBsdf b, vec3 wo, vec2 u) {
  vec3 wi = sample_cosine_hemisphere(u);
  float pdf = wo.z > 0.0 ? pdf_cosine_hemisphere(wi.z) : 0.0;
  return BsdfSample(wi, pdf > 0.0 ? b.reflectance : vec3(0.0), pdf, 0u, 1.0);
}

BsdfEval eval_diffuse(DiffuseBsdf b, vec3 wo, vec3 wi) {
  float pdf = wo.z > 0.0 ? pdf_cosine_hemisphere(wi.z) : 0.0;
  return BsdfEval(b.reflectance * pdf, pdf);
}

#endif
