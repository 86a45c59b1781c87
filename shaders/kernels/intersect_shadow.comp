// Adds the contribution of each shadow ray that nothing blocks.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/features.glsl"
#include "base/queues.glsl"
#include "shared/geometry.h"
layout(set = 0, binding = kBindLeafInfo) uniform usamplerBuffer leaf_info;
#include "geometry/bvh.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= counters[kCounterShadow]) return;
  vec4 o = load_shadow(0u, i), d = load_shadow(1u, i), c = load_shadow(2u, i);
  uint target = floatBitsToUint(d.w);
  float tmax = target == kTargetInfinite ? uintBitsToFloat(0x7f800000u) : 1.0;
  TraceHit hit = trace_ray(TraceRay(o.xyz, d.xyz, tmax, floatBitsToUint(o.w), target), true);
  if (hit.id == kNoHit) add_radiance(floatBitsToUint(c.w), c.xyz);
}
