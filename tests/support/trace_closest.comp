// Traces rays of support/tracer.h. ANY: any hit. PLAIN: one ray a lane, lanes are not refilled.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "geometry/bvh.glsl"
#include "shared/bindings.h"

layout(set = 0, binding = kBindPathTexels) uniform samplerBuffer rays;
layout(set = 0, binding = kBindPaths) writeonly restrict buffer Hits { vec4 hits[]; };
layout(push_constant) uniform Push { uint count; };

#ifdef ANY
const bool any_hit = true;
#else
const bool any_hit = false;
#endif

uint ray_at(uint i) { return i; }
TraceRay fetch_ray(uint i) {
  vec4 o = texelFetch(rays, int(2u * i)), d = texelFetch(rays, int(2u * i + 1u));
  return TraceRay(o.xyz, d.xyz, o.w, floatBitsToUint(d.w), kNoHit);
}
Traversal begin_ray(uint i, const bool any) { return begin_traversal(fetch_ray(i)); }
void end_ray(uint i, TraceHit hit, const bool any) { hits[i] = vec4(uintBitsToFloat(hit.id), hit.b1, hit.b2, hit.t); }

#ifdef PLAIN
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < count) end_ray(i, trace_ray(fetch_ray(i), any_hit), any_hit);
}
#else
#include "geometry/trace_rays.glsl"
void main() {
  uint first = gl_WorkGroupID.x * kRaysPerGroup + first_ray_in_group();
  trace_rays(first, min(first + rays_per_subgroup(), count), any_hit);
}
#endif
