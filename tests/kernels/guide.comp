#version 460
#extension GL_GOOGLE_include_directive : require
// samples[i] = (u, density, bin of the direction) of guided numbers of one cell, or of uniform numbers with the density
// that guide_density gives for their direction.
#include "base/warp.glsl"
#include "path/guide_table.glsl"
#include "shared/sampler.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool kGuided = true;
layout(push_constant) uniform Push { uint count; uint cell; };
layout(set = 0, binding = 1) writeonly buffer Out { vec4 samples[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  const vec2 u = unit_float4(sample_group(kSamplerIndependent, pixel_key(1u, 2u), i, 0u, 24u)).xy;
  GuidedNumbers guided = GuidedNumbers(u, 1.0);
  if (kGuided) guided = guide_numbers(cell * kGuideCellBins, u);
  const vec3 w = sample_cosine_hemisphere(guided.u);
  samples[i] = vec4(guided.u, kGuided ? guided.density : guide_density(cell * kGuideCellBins, w), float(guide_bin(w)));
}
