// The phase function of a medium: a sum of Henyey-Greenstein lobes. d is the direction of travel before, wi after.
#ifndef TACHYLITE_MEDIUM_PHASE_GLSL
#define TACHYLITE_MEDIUM_PHASE_GLSL
#include "medium/henyey_greenstein.glsl"
#include "medium/record.glsl"

struct Phase {
  float g;            // of the only lobe, where no phase function of the scene has several
  uint first, count;  // rows of lobes
};

Phase load_phase(uint medium) {
  Phase phase;
  phase.first = floatBitsToUint(load_medium(medium * kMediumRows + 1u).w);
  phase.count = floatBitsToUint(load_medium(medium * kMediumRows).w) >> 8u;
  phase.g = load_medium(phase.first).z;
  return phase;
}

/// The value [1/sr], and the density of sample_phase w.r.t. solid angle.
float eval_phase(Phase phase, vec3 d, vec3 wi) {
  if (!has_medium(kMediaBlended)) return pdf_henyey_greenstein(phase.g, d, wi);
  float sum = 0.0;
  for (uint i = 0u; i < phase.count; ++i) {
    vec4 lobe = load_medium(phase.first + i);
    sum += lobe.y * pdf_henyey_greenstein(lobe.z, d, wi);
  }
  return sum;
}

vec3 sample_phase(Phase phase, vec3 d, vec2 u, float u_lobe) {
  float g = phase.g;
  if (has_medium(kMediaBlended)) {
    for (uint i = 1u; i < phase.count; ++i) {
      // Lobe i where u lies above all lobes before it.
      bool above = u_lobe >= load_medium(phase.first + i - 1u).x;
      g = above ? load_medium(phase.first + i).z : g;
    }
  }
  return sample_henyey_greenstein(g, d, u);
}

#endif
