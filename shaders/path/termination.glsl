// When paths end.
#ifndef TACHYLITE_PATH_TERMINATION_GLSL
#define TACHYLITE_PATH_TERMINATION_GLSL
#include "base/features.glsl"
#include "base/math.glsl"

// Survival probability of Russian roulette: twice the largest component of the throughput, at most 0.95, with the
// scaling of radiance by refraction undone.
float survival_probability(vec4 beta) { return min(0.95, 2.0 * beta.w * max_component(beta.xyz)); }

// Whether some path takes part in Russian roulette.
bool has_roulette() { return roulette_depth < max_depth; }

// Whether a path of `edges` edges goes on: the next ray must still be able to find light.
bool goes_on(uint edges) {
  return has_escaped_light() || has_area_light() ? edges < max_depth : edges + 1u < max_depth;
}

#endif
