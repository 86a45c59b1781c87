// Rays that are made in the lane, through baked primitives (bench/bounces.h). SHADOW: with shadow rays.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define BAKED_COUNT 64
#include "base/frame.glsl"
#include "base/warp.glsl"
#include "geometry/baked.glsl"
#include "shared/bindings.h"
#include "shared/bvh.h"
#include "shared/rng.h"

layout(set = 0, binding = kBindBaked) uniform samplerBuffer baked;
layout(set = 0, binding = kBindPathTexels) uniform samplerBuffer rays;  // primary
layout(set = 0, binding = kBindPaths) writeonly restrict buffer Sums { vec2 sums[]; };
const float kOffset = 1e-4;  // off the surface, along its normal; and of a shadow ray, off the light

layout(push_constant) uniform Push {
  vec4 corner, edge_u, edge_v;  // of the light
  uint count, bounces;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  vec3 eye = texelFetch(rays, int(2u * i)).xyz, view = texelFetch(rays, int(2u * i + 1u)).xyz;
  BakedRay ray = BakedRay(eye, view, kNoHit, kNoHit);
  float distances = 0.0, seen = 0.0;
  for (uint k = 0u; k < bounces; k++) {
    float t = infinity();
    uint primitive = closest_baked(ray, t);
    bool is_hit = primitive != kNoHit;
    distances += is_hit ? t : 0.0;

    vec3 n = texelFetch(baked, int((is_hit ? primitive : 0u) * kBakedRows)).xyz;
    n = dot(n, ray.d) > 0.0 ? -n : n;
    vec3 p = ray.o + t * ray.d + kOffset * n;
    uvec4 bits = hash_pcg4d(uvec4(i, k, 0u, 0u));
#ifdef SHADOW
    vec3 to_light = corner.xyz + unit_float(bits.z) * edge_u.xyz + unit_float(bits.w) * edge_v.xyz - p;
    seen += is_hit && !any_baked(BakedRay(p, to_light, kNoHit, kNoHit), 1.0 - kOffset) ? 1.0 : 0.0;
#endif
    vec3 d = to_world(frame_from_normal(n), sample_cosine_hemisphere(vec2(unit_float(bits.x), unit_float(bits.y))));
    ray.o = is_hit ? p : eye;
    ray.d = is_hit ? d : view;
  }
  sums[i] = vec2(distances, seen);
}
