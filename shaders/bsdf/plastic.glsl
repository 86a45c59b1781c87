// A diffuse base under a smooth dielectric coat, with the light that the coat reflects back inside. One-sided.
// f of the base = rho (1 - F(wo)) (1 - F(wi)) / (pi eta^2 (1 - rho' F_internal)); rho' is rho (nonlinear) or 1.
// Inputs: 0 diffuse reflectance, 1 specular reflectance, 2 constants (eta^2 - 1, F_internal, 1 / eta^2, nonlinear as
// 0 or 1). F_internal: reflectance of the coat for diffuse light from inside.
#ifndef TACHYLITE_BSDF_PLASTIC_GLSL
#define TACHYLITE_BSDF_PLASTIC_GLSL
#include "base/warp.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/input.glsl"
#include "bsdf/lobe.glsl"

struct PlasticBsdf {
  vec3 base;      // f of the base over the two transmittances and 1 / pi
  vec3 reflectance;
  float e;
  float base_weight, coat_weight;  // estimates of the albedos of base and coat over T(wo) and R(wo)
};

PlasticBsdf load_plastic(uint leaf, TexturePoint point) {
  vec3 rho = load_color(leaf, 0u, point);
  vec3 reflectance = load_color(leaf, 1u, point);
  vec4 constants = load_constants(leaf, 2u);
  vec3 interreflected = constants.w != 0.0 ? rho : vec3(1.0);
  vec3 base = rho * constants.z / (1.0 - interreflected * constants.y);
  // The mean of 1 - F(wi) over the cosine-weighted hemisphere is eta^2 (1 - F_internal).
  return PlasticBsdf(base, reflectance, constants.x, mean(base) * (1.0 - constants.y) / constants.z,
                     mean(reflectance));
}

// Probability of sampling the coat, which reflects `r` of the light to wo.
float coat_probability(PlasticBsdf b, float r) {
  float coat = r * b.coat_weight, base = (1.0 - r) * b.base_weight;
  return coat > 0.0 ? coat / (coat + base) : 0.0;
}

BsdfSample sample_plastic(PlasticBsdf b, vec3 wo, vec2 u, float u_lobe) {
  float r = fresnel_dielectric(abs(wo.z), b.e);
  float p = coat_probability(b, r);
  vec3 wi = sample_cosine_hemisphere(u);
  float pdf = (1.0 - p) * pdf_cosine_hemisphere(wi.z);
  float t = (1.0 - r) * (1.0 - fresnel_dielectric(wi.z, b.e));
  BsdfSample s = BsdfSample(wi, b.base * (t / (1.0 - p)), pdf, 0u, 1.0);
  if (pdf == 0.0) s = absorbed();
  if (u_lobe < p) s = BsdfSample(vec3(-wo.xy, wo.z), b.reflectance * (r / p), 0.0, kLobeDelta, 1.0);
  if (!(wo.z > 0.0)) s = absorbed();
  return s;
}

BsdfEval eval_plastic(PlasticBsdf b, vec3 wo, vec3 wi) {
  float r = fresnel_dielectric(abs(wo.z), b.e);
  float lambert = wo.z > 0.0 ? pdf_cosine_hemisphere(wi.z) : 0.0;
  float t = (1.0 - r) * (1.0 - fresnel_dielectric(abs(wi.z), b.e));
  return BsdfEval(b.base * (t * lambert), (1.0 - coat_probability(b, r)) * lambert);
}

#endif
