// Finds the closest hit of each queued ray and sorts the paths into the queues of the stages that follow.
// PRIMARY: camera rays, whose length is bounded by the far clip plane.
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
  if (i >= queue_length(wave.ray_queue)) return;
  uint slot = load_queue(wave.ray_queue, i);
  vec4 o = load_path(kPathOrigin, slot), d = load_path(kPathDirection, slot);
#ifdef PRIMARY
  float tmax = load_path(kPathHit, slot).w;
#else
  float tmax = uintBitsToFloat(0x7f800000u);
#endif
  TraceHit hit = trace_ray(TraceRay(o.xyz, d.xyz, tmax, floatBitsToUint(o.w), kNoHit), false);
#ifdef PRIMARY
  // Area lights are transparent to the camera.
  if (hide_emitters)
    for (int k = 0; k < 8; ++k)
      if (hit.id != kNoHit && (texelFetch(leaf_info, int(hit.id >> 1u)).z & kLeafEmits) != 0u) {
        TraceRay rest = TraceRay(o.xyz + hit.t * d.xyz, d.xyz, tmax - hit.t, hit.id, kNoHit);
        float before = hit.t;
        hit = trace_ray(rest, false);
        hit.t += before;
      }
#endif
  store_path(kPathHit, slot, vec4(uintBitsToFloat(hit.id), hit.b1, hit.b2, hit.t));

  bool found = hit.id != kNoHit;
  uvec4 info = found ? texelFetch(leaf_info, int(hit.id >> 1u)) : uvec4(0u);
  uint path_class = (info.z >> kLeafClassShift) & kLeafClassMask;
  bool counts = !(hide_emitters && wave.bounce == 0u);
  if (has_area_light()) append_to_queue(kQueueEmitter, found && counts && (info.z & kLeafEmits) != 0u, slot);
  if (has_escaped_light()) append_to_queue(kQueueEscaped, !found && counts, slot);
  bool goes_on = wave.bounce + 1u < max_depth;
  for (uint c = 0u; c < class_count; ++c) append_to_queue(kQueueSurface + c, found && goes_on && path_class == c, slot);
}
