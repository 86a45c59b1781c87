// Finds the closest hit of each queued ray and sorts the paths into the queues of the stages that follow.
// PRIMARY: camera rays, whose length is bounded by the far clip plane.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/features.glsl"
#include "base/queues.glsl"
#include "geometry/bvh.glsl"
#include "shared/geometry.h"
#include "path/listed_rays.glsl"
#include "path/sort_paths.glsl"
#include "path/volume_path.glsl"

TraceRay load_ray(uint place) {
  uint slot = load_queue(wave.ray_queue, place);
  vec4 o = load_path(kPathOrigin, slot), d = load_path(kPathDirection, slot);
#ifdef PRIMARY
  float tmax = load_path(kPathHit, slot).w;
#else
  float tmax = uintBitsToFloat(0x7f800000u);
#endif
  return TraceRay(o.xyz, d.xyz, tmax, floatBitsToUint(o.w), kNoHit);
}

bool is_emitter(uint hit) { return (load_leaf_info(hit >> 1u).z & kLeafHides) != 0u; }

// Whether the ray is a part of the camera's edge; null surfaces on the way do not end that.
bool is_cameras(uint slot) {
#ifdef PRIMARY
  return true;
#else
  return is_volumetric() && load_volume_path(slot).edges == 1u;
#endif
}

void finish_ray(uint place, TraceHit hit) {
  uint slot = load_queue(wave.ray_queue, place);
  // Area lights are transparent to the camera.
  if (hide_emitters && is_cameras(slot)) {
    TraceRay ray = load_ray(place);
    bool hidden = hit.id != kNoHit && is_emitter(hit.id);
    for (int k = 0; k < 8 && hidden; ++k) {
      TraceRay rest = TraceRay(ray.o + hit.t * ray.d, ray.d, ray.tmax - hit.t, hit.id, kNoHit);
      float before = hit.t;
      hit = trace_ray(rest, false);
      hit.t += before;
      hidden = hit.id != kNoHit && is_emitter(hit.id);
    }
  }
  store_path(kPathHit, slot, vec4(uintBitsToFloat(hit.id), hit.b1, hit.b2, hit.t));
  destinations[place % kRaysPerGroup] = hit.id;
}

uint destination(uint place) {
  uint edges = is_volumetric() ? load_volume_path(load_queue(wave.ray_queue, place)).edges : wave.bounce + 1u;
  return queues_after(destinations[place % kRaysPerGroup], edges);
}

#include "path/walls.glsl"
#include "geometry/trace_rays.glsl"

void main() {
  uint first = first_ray_in_group();
  RayList list = list_rays(wave.ray_queue, first);
  count_rays(kCounterClosestTotal, list.count);
  trace_rays(first, first + trace_walls(first, list.count, false), false);
  report_unfinished(rays_unfinished);
  if (has_media()) return;  // sample_medium sorts

  subgroupMemoryBarrierShared();
  subgroupBarrier();
  sort_paths(first_place(first), list.mask);
}
