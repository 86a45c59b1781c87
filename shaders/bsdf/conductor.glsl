// A smooth metal: a mirror with the Fresnel reflectance of a conductor. One-sided.
// Inputs: 0 eta, 1 k (relative to the outside), 2 specular reflectance.
#ifndef TACHYLITE_BSDF_CONDUCTOR_GLSL
#define TACHYLITE_BSDF_CONDUCTOR_GLSL
#include "bsdf/fresnel.glsl"
#include "bsdf/input.glsl"
#include "bsdf/lobe.glsl"

struct ConductorBsdf { vec3 eta, k, reflectance; };

ConductorBsdf load_conductor(uint leaf, TexturePoint point) {
  return ConductorBsdf(load_color(leaf, 0u, point), load_color(leaf, 1u, point), load_color(leaf, 2u, point));
}

BsdfSample sample_conductor(ConductorBsdf b, vec3 wo) {
  vec3 f = b.reflectance * fresnel_conductor(abs(wo.z), b.eta, b.k);
  return BsdfSample(vec3(-wo.xy, wo.z), wo.z > 0.0 ? f : vec3(0.0), 0.0, kLobeDelta, 1.0);
}

#endif
