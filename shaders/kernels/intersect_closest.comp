// Finds the closest hit of each queued ray and sorts the paths into the queues of the stages that follow.
// PRIMARY: camera rays, whose length is bounded by the far clip plane.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/features.glsl"
#include "base/queues.glsl"
#include "geometry/bvh.glsl"
#include "geometry/trace_settings.glsl"
#include "shared/geometry.h"
layout(set = 0, binding = kBindLeafInfo) uniform usamplerBuffer leaf_info;
#include "path/sort_path.glsl"
#include "path/volume_path.glsl"

// Hit ids of this workgroup's rays.
shared uint hit_ids[kRaysPerGroup];

TraceRay fetch_ray(uint i) {
  uint slot = load_queue(wave.ray_queue, i);
  vec4 o = load_path(kPathOrigin, slot), d = load_path(kPathDirection, slot);
#ifdef PRIMARY
  float tmax = load_path(kPathHit, slot).w;
#else
  float tmax = uintBitsToFloat(0x7f800000u);
#endif
  return TraceRay(o.xyz, d.xyz, tmax, floatBitsToUint(o.w), kNoHit);
}

bool is_emitter(uint hit) { return (texelFetch(leaf_info, int(hit >> 1u)).z & kLeafHides) != 0u; }

// Whether ray i is a part of the camera's edge; null surfaces on the way do not end that.
bool is_cameras(uint i) {
#ifdef PRIMARY
  return true;
#else
  return is_volumetric() && load_volume_path(load_queue(wave.ray_queue, i)).edges == 1u;
#endif
}

void store_hit(uint i, TraceHit hit) {
  // Area lights are transparent to the camera.
  if (hide_emitters && is_cameras(i)) {
    TraceRay ray = fetch_ray(i);
    bool hidden = hit.id != kNoHit && is_emitter(hit.id);
    for (int k = 0; k < 8 && hidden; ++k) {
      TraceRay rest = TraceRay(ray.o + hit.t * ray.d, ray.d, ray.tmax - hit.t, hit.id, kNoHit);
      float before = hit.t;
      hit = trace_ray(rest, false);
      hit.t += before;
      hidden = hit.id != kNoHit && is_emitter(hit.id);
    }
  }
  store_path(kPathHit, load_queue(wave.ray_queue, i), vec4(uintBitsToFloat(hit.id), hit.b1, hit.b2, hit.t));
  hit_ids[i % kRaysPerGroup] = hit.id;
}

#include "geometry/trace_rays.glsl"

void main() {
  uint count = queue_length(wave.ray_queue);
  trace_rays(count, false);
  report_unfinished(rays_unfinished);
  if (has_media()) return;  // sample_medium sorts

  // All lanes again have a ray each, in the order of the queue.
  subgroupMemoryBarrierShared();
  subgroupBarrier();
  for (uint k = 0u; k < rays_per_lane(); ++k) {
    uint i = first_ray() + k * gl_SubgroupSize + gl_SubgroupInvocationID;
    uint slot = i < count ? load_queue(wave.ray_queue, i) : 0u;
    sort_path(i < count, slot, i < count ? hit_ids[i % kRaysPerGroup] : kNoHit, load_volume_path(slot).edges);
  }
}
