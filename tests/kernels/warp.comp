#version 460
#extension GL_GOOGLE_include_directive : require
// out[i] = a sample of a map of base/warp.glsl with independent numbers, w = its density; or, of the directions given,
// the density. Maps are numbered as in warp_test.cpp.
#include "base/frame.glsl"
#include "base/warp.glsl"
#include "shared/sampler.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kMap = 0u;
layout(constant_id = 1) const bool kDensity = false;
layout(push_constant) uniform Push { uint count; uint seed; float omc; };
layout(set = 0, binding = 0) readonly buffer In { vec4 directions[]; };
layout(set = 0, binding = 1) writeonly buffer Out { vec4 samples[]; };

float pdf_of(vec3 w) {
  switch (kMap) {
    case 0u: return pdf_uniform_disk();
    case 1u: return pdf_uniform_triangle(0.5);
    case 2u: return pdf_cosine_hemisphere(w.z);
    case 3u: return pdf_uniform_sphere();
    case 4u: return w.z >= 0.0 ? pdf_uniform_hemisphere() : 0.0;
    default: return pdf_uniform_cone(omc);
  }
}

vec3 sample_of(vec2 u) {
  switch (kMap) {
    case 0u: return vec3(sample_uniform_disk(u), 0.0);
    case 1u: return sample_uniform_triangle(u);
    case 2u: return sample_cosine_hemisphere(u);
    case 3u: return sample_uniform_sphere(u);
    case 4u: return sample_uniform_hemisphere(u);
    default: return sample_uniform_cone(u, omc);
  }
}

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  if (kMap == 6u) {  // the frame of a direction: s, t and n in turn
    const Frame f = frame_from_normal(directions[i / 3u].xyz);
    const vec3 back = to_world(f, to_local(f, vec3(0.1, -0.2, 0.3)));
    samples[i] = vec4(i % 3u == 0u ? f.s : (i % 3u == 1u ? f.t : f.n), length(back - vec3(0.1, -0.2, 0.3)));
  } else if (kDensity) {
    samples[i] = vec4(pdf_of(directions[i].xyz));
  } else {
    const vec3 w = sample_of(unit_float4(hash_pcg4d(uvec4(i, seed, 1u, 2u))).xy);
    samples[i] = vec4(w, pdf_of(w));
  }
}
