#version 460
#extension GL_GOOGLE_include_directive : require
// The cone of a sphere from the origin, or a choice among focusers; samples[i] =
//   kMode 0: uniform numbers, and those that focus_numbers finds for their direction
//   1: the numbers of a uniform direction of the sphere, the cone's density, whether it is in the square
//   2: the choice by shares sphere.xyz, the number after it
#include "base/warp.glsl"
#include "path/focus_cone.glsl"
#include "shared/sampler.h"
layout(local_size_x = 64) in;
layout(constant_id = 100) const uint kMode = 0u;
layout(push_constant) uniform Push { vec4 sphere; };
layout(set = 0, binding = 1) writeonly buffer Out { vec4 samples[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  vec2 u = unit_float4(sample_group(kSamplerIndependent, pixel_key(3u, 4u), i, 0u, 24u)).xy;
  FocusCone cone = focus_cone(sphere, vec3(0.0), vec3(1.0, 0.0, 0.0));
  if (kMode == 0u) {
    samples[i] = vec4(u, focus_numbers(cone, focus_direction(cone, u)));
  } else if (kMode == 1u) {
    vec2 v = focus_numbers(cone, sample_uniform_sphere(u));
    samples[i] = vec4(v, pdf_focus_cone(cone), is_in_square(v) ? 1.0 : 0.0);
  } else {
    uint chosen = choose_focuser(vec4(sphere.xyz, 0.0), u.x);
    samples[i] = vec4(float(chosen), u.x, 0.0, 0.0);
  }
}
