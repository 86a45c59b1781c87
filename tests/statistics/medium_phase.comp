#version 460
#extension GL_GOOGLE_include_directive : require
// out[i] = a sample of Henyey and Greenstein's phase function about d, w = its density; with kDensity, the density of
// the direction given.
#include "medium/henyey_greenstein.glsl"
#include "shared/sampler.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool kDensity = false;
layout(push_constant) uniform Push { vec4 d; float g; uint count; };
layout(set = 0, binding = 0) readonly buffer In { vec4 directions[]; };
layout(set = 0, binding = 1) writeonly buffer Out { vec4 samples[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  if (kDensity) {
    samples[i] = vec4(pdf_henyey_greenstein(g, d.xyz, directions[i].xyz));
    return;
  }
  const vec2 u = unit_float4(hash_pcg4d(uvec4(i, 1u, 2u, 3u))).xy;
  const vec3 wi = sample_henyey_greenstein(g, d.xyz, u);
  samples[i] = vec4(wi, pdf_henyey_greenstein(g, d.xyz, wi));
}
