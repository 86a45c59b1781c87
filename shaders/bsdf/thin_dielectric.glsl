// A pane of glass without thickness: reflections between its two sides are summed, R' = 2 R / (1 + R), the rest goes
// straight on. Inputs as the dielectric.
#ifndef TACHYLITE_BSDF_THIN_DIELECTRIC_GLSL
#define TACHYLITE_BSDF_THIN_DIELECTRIC_GLSL
#include "bsdf/fresnel.glsl"
#include "bsdf/input.glsl"
#include "bsdf/lobe.glsl"

struct ThinDielectricBsdf {
  vec3 reflectance, transmittance;
  float e;
};

ThinDielectricBsdf load_thin_dielectric(uint leaf, TexturePoint point) {
  return ThinDielectricBsdf(load_color(leaf, 0u, point), load_color(leaf, 1u, point), load_constants(leaf, 2u).z);
}

float thin_reflectance(ThinDielectricBsdf b, float cos_o) {
  float r = fresnel_dielectric(abs(cos_o), b.e);
  return 2.0 * r / (1.0 + r);
}

BsdfSample sample_thin_dielectric(ThinDielectricBsdf b, vec3 wo, float u_lobe) {
  BsdfSample s = BsdfSample(vec3(-wo.xy, wo.z), b.reflectance, 0.0, kLobeDelta, 1.0);
  if (u_lobe >= thin_reflectance(b, wo.z))
    s = BsdfSample(-wo, b.transmittance, 0.0, kLobeDelta | kLobeTransmission | kLobeNull, 1.0);
  return s;
}

// What goes straight on.
vec3 null_transmission_thin_dielectric(ThinDielectricBsdf b, float cos_o) {
  return b.transmittance * (1.0 - thin_reflectance(b, cos_o));
}

#endif
