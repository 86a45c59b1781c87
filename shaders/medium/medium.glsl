// Media: the switch over their kinds.
#ifndef TACHYLITE_MEDIUM_MEDIUM_GLSL
#define TACHYLITE_MEDIUM_MEDIUM_GLSL
#include "medium/grid.glsl"
#include "medium/homogeneous.glsl"
#include "medium/record.glsl"

/// Flies along the ray (unit d) up to tmax. u: raw bits (distance, channel).
FreeFlight fly_medium(uint medium, vec3 o, vec3 d, float tmax, vec3 beta, uvec2 u, WalkRandom random,
                      inout bool overflow) {
  vec4 row0 = load_medium(medium * kMediumRows);
  FreeFlight flight;
  if (has_medium(kMediaHomogeneous))
    flight = fly_homogeneous(row0.xyz, load_medium(medium * kMediumRows + 1u).xyz, tmax, beta, u);
  if (has_medium(kMediaGrids)) {
    bool grid = is_grid(row0);
    // Lanes in other media have no way to go.
    FreeFlight in_grid = fly_grid(medium, o, d, grid ? tmax : 0.0, beta, random, overflow);
    if (grid) flight = in_grid;
  }
  return flight;
}

/// The transmittance up to tmax (d of any length) is transmittance * exp(-depth): adds to both.
void attenuate(uint medium, vec3 o, vec3 d, float tmax, WalkRandom random, inout vec3 depth, inout vec3 transmittance,
               inout bool overflow) {
  vec4 row0 = load_medium(medium * kMediumRows);
  bool grid = is_grid(row0);
  if (has_medium(kMediaHomogeneous) && !grid) depth += optical_depth_homogeneous(row0.xyz, tmax * length(d));
  if (has_medium(kMediaGrids))
    transmittance *= transmittance_grid(medium, o, d, grid ? tmax : 0.0, random, overflow);
}

#endif
