// Traces rays of support/tracer.h. ANY: any hit. PLAIN: one ray a lane, lanes are not refilled. BAKED: so, too, through
// primitives that are constants.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#ifdef BAKED
#define BAKED_COUNT 64
#include "geometry/baked.glsl"
#include "geometry/ray.glsl"
#else
#include "geometry/bvh.glsl"
#endif
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
void end_ray(uint i, TraceHit hit, const bool any) { hits[i] = vec4(uintBitsToFloat(hit.id), hit.b1, hit.b2, hit.t); }

#ifdef BAKED
TraceHit trace_ray(TraceRay ray, const bool any) {
  BakedRay baked = BakedRay(ray.o, ray.d, ray.ignored, ray.ignored_target);
  if (any) return TraceHit(any_baked(baked, ray.tmax) ? 0u : kNoHit, 0.0, 0.0, ray.tmax);
  float t = ray.tmax;
  uint primitive = closest_baked(baked, t);
  return TraceHit(primitive, 0.0, 0.0, t);
}
#endif

#if defined(PLAIN) || defined(BAKED)
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < count) end_ray(i, trace_ray(fetch_ray(i), any_hit), any_hit);
}
#else
Traversal begin_ray(uint i, const bool any) { return begin_traversal(fetch_ray(i)); }
#include "geometry/trace_rays.glsl"
void main() {
  uint first = gl_WorkGroupID.x * kRaysPerGroup + first_ray_in_group();
  trace_rays(first, min(first + rays_per_subgroup(), count), any_hit);
}
#endif
