// Homogeneous media.
#ifndef TACHYLITE_MEDIUM_HOMOGENEOUS_GLSL
#define TACHYLITE_MEDIUM_HOMOGENEOUS_GLSL
#include "base/math.glsl"
#include "medium/free_flight.glsl"
#include "medium/record.glsl"

// Uniform in (0, 1) with 32 bits: small values keep their digits, which thin media need.
float open_unit(uint bits) { return min((float(bits) + 0.5) * 2.3283064e-10, 1.0 - kEpsilon); }

// The channel is chosen in proportion to the throughput and the density mixed over the channels with the same
// probabilities, so that the sum of the throughput never grows: Wilkie et al. 2014, "Hero Wavelength Spectral
// Sampling", in the form of the single-sample balance heuristic of Miller et al. 2019, "A null-scattering path
// integral formulation of light transport". The factor exp(-min sigma t) that all channels share cancels and is left
// out: nothing underflows at any optical depth. Where sigma_t is grey, beta only changes by the albedo.
// u: raw bits (distance, channel).
FreeFlight fly_homogeneous(vec3 sigma_t, vec3 albedo, float tmax, vec3 beta, uvec2 u) {
  float sigma = sigma_t.x;
  vec3 p = vec3(1.0, 0.0, 0.0);
  bool chromatic = has_medium(kMediaChromatic) && (sigma_t.y != sigma_t.x || sigma_t.z != sigma_t.x);
  if (has_medium(kMediaChromatic)) {
    p = has_medium(kMediaUniformChannel) ? vec3(1.0 / 3.0) : beta / (beta.x + beta.y + beta.z);
    float u_channel = unit_float(u.y);
    sigma = u_channel < p.x ? sigma_t.x : (u_channel < p.x + p.y || p.z == 0.0 ? sigma_t.y : sigma_t.z);
  }
  float t = sigma > 0.0 ? -xlog1p(-open_unit(u.x)) / sigma : infinity();
  FreeFlight flight;
  flight.collides = t < tmax;
  flight.t = flight.collides ? t : tmax;
  flight.beta = flight.collides ? beta * albedo : beta;
  if (has_medium(kMediaChromatic)) {
    float sigma_min = min(p.x > 0.0 ? sigma_t.x : kMaxFloat,
                          min(p.y > 0.0 ? sigma_t.y : kMaxFloat, p.z > 0.0 ? sigma_t.z : kMaxFloat));
    vec3 excess = max(sigma_t - sigma_min, vec3(0.0));
    vec3 e = mix(vec3(1.0), xexp(-excess * flight.t), greaterThan(excess, vec3(0.0)));
    if (flight.collides) e *= sigma_t;
    if (chromatic) flight.beta *= e / dot(p, e);
  }
  return flight;
}

// Optical depth of a length, which may be infinite.
vec3 optical_depth_homogeneous(vec3 sigma_t, float distance) {
  return mix(vec3(0.0), sigma_t * distance, greaterThan(sigma_t, vec3(0.0)));
}

#endif
