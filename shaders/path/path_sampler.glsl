// The sample numbers of a path by what they are for; which dimensions they are stands in shared/sampler.h.
#ifndef TACHYLITE_PATH_PATH_SAMPLER_GLSL
#define TACHYLITE_PATH_PATH_SAMPLER_GLSL
#include "base/features.glsl"
#include "shared/sampler.h"

struct PathSampler {
  uint key, index;
};

PathSampler begin_path_sampler(uint pixel, uint sample_index, uint seed) {
  return PathSampler(pixel_key(pixel, seed), sample_index);
}

// Whether paths have vertices whose samples are hashed; media count null collisions, too.
bool has_hashed_vertices() { return media_kinds != 0u || max_depth > kFirstHashedVertex; }

vec4 path_sample(PathSampler s, uint group) {
  if (sampler_kind == kSamplerSobol && !has_hashed_vertices())
    return unit_float4(sobol_group(s.key, s.index, group, log2_samples));
  return unit_float4(sample_group(sampler_kind, s.key, s.index, group, log2_samples));
}

// xy: position in the pixel; zw: light point of vertex 0.
vec4 camera_sample(PathSampler s) { return path_sample(s, kGroupCamera); }
vec2 lens_sample(PathSampler s) { return path_sample(s, kGroupLens).xy; }
// xy: direction at a vertex; zw: light point of the next vertex.
vec4 direction_sample(PathSampler s, uint vertex) { return path_sample(s, group_directions(vertex)); }
// Light point of a vertex, which came with the direction that led there.
vec2 light_point_sample(PathSampler s, uint vertex) {
  return path_sample(s, vertex == 0u ? kGroupCamera : group_directions(vertex - 1u)).zw;
}
// x: choice of a light, y: of a lobe, z: Russian roulette.
vec4 choice_sample(PathSampler s, uint vertex) { return path_sample(s, group_choices(vertex)); }

#endif
