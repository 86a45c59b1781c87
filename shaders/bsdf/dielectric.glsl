// A smooth interface between dielectrics: Fresnel reflection and refraction.
// Inputs: 0 specular reflectance, 1 specular transmittance, 2 constants of fresnel.glsl's interface_from.
#ifndef TACHYLITE_BSDF_DIELECTRIC_GLSL
#define TACHYLITE_BSDF_DIELECTRIC_GLSL
#include "bsdf/fresnel.glsl"
#include "bsdf/input.glsl"
#include "bsdf/lobe.glsl"

struct DielectricBsdf {
  vec3 reflectance, transmittance;
  Interface side;  // as seen from wo
};

DielectricBsdf load_dielectric(uint leaf, vec3 wo, TexturePoint point) {
  return DielectricBsdf(load_color(leaf, 0u, point), load_color(leaf, 1u, point),
                        interface_from(load_constants(leaf, 2u), wo.z > 0.0));
}

BsdfSample sample_dielectric(DielectricBsdf b, vec3 wo, float u_lobe) {
  float gap;
  float reflected = fresnel_dielectric(abs(wo.z), b.side.e, gap);
  vec3 wt = refract_by_gap(wo, vec3(0.0, 0.0, wo.z > 0.0 ? 1.0 : -1.0), gap, b.side.inv_eta);
  BsdfSample s = BsdfSample(vec3(-wo.xy, wo.z), b.reflectance, 0.0, kLobeDelta, 1.0);
  if (u_lobe >= reflected)
    s = BsdfSample(wt, b.transmittance * sqr(b.side.inv_eta), 0.0, kLobeDelta | kLobeTransmission, b.side.eta);
  return s;
}

#endif
