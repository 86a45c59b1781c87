// Adds the contribution of each shadow ray that nothing blocks.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/features.glsl"
#include "base/queues.glsl"
#include "geometry/bvh.glsl"
#include "path/listed_rays.glsl"

TraceRay load_ray(uint place) {
  vec4 o = load_shadow(0u, place), d = load_shadow(1u, place);
  uint target = floatBitsToUint(d.w);
  float tmax = target == kTargetInfinite ? uintBitsToFloat(0x7f800000u) : 1.0;
  return TraceRay(o.xyz, d.xyz, tmax, floatBitsToUint(o.w), target);
}

void finish_ray(uint place, TraceHit hit) {
  vec4 contribution = load_shadow(2u, place);
  if (hit.id == kNoHit) add_radiance(floatBitsToUint(contribution.w), contribution.xyz);
}

#include "path/walls.glsl"
#include "geometry/trace_rays.glsl"

void main() {
  uint first = first_ray_in_group();
  uint count = list_rays(kQueueShadow, first).count;
  count_rays(kCounterShadowTotal, count);
  trace_rays(first, first + trace_walls(first, count, true), true);
  report_unfinished(rays_unfinished);
}
