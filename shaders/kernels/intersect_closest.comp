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
#include "path/sort_path.glsl"
#include "path/volume_path.glsl"

// Of this workgroup's places, first what their rays hit, then where their paths go.
shared uint hit_ids[kRaysPerGroup];

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
  hit_ids[place % kRaysPerGroup] = hit.id;
}

#include "path/walls.glsl"
#include "geometry/trace_rays.glsl"

// Appends the paths of this subgroup's rays to their queues: six queues at a time, with one atomic each. Each lane has
// neighbouring rays, so that entries keep the order of the rays.
void sort_paths(uint begin, uint mask) {
  for (uint queue = kQueueEmitter; queue < kQueueSurface + class_count; queue += 6u) {
    uvec3 lengths = uvec3(0u);  // of the lane's parts of the six, 16 bits each
    for (uint k = 0u; k < kRaysPerLane; ++k) {
      uint i = (begin + k) % kRaysPerGroup, queues = hit_ids[i];
      if (queue == kQueueEmitter) {
        uint edges = is_volumetric() ? load_volume_path(load_queue(wave.ray_queue, begin + k)).edges : wave.bounce + 1u;
        queues = (mask & 1u << k) != 0u ? queues_after(queues, edges) : kNoQueues;
        hit_ids[i] = queues;
      }
      uint q = surface_queue(queues) - queue;
      uint one = 1u << (16u * (q & 1u));
      lengths += uvec3(q < 2u ? one : 0u, (q & ~1u) == 2u ? one : 0u, (q & ~1u) == 4u ? one : 0u);
      if (has_area_light() && queue == kQueueEmitter && goes_to_emitter(queues)) lengths.x += 1u;
    }
    uvec3 before = subgroupExclusiveAdd(lengths), all = subgroupAdd(lengths);
    uvec3 low = uvec3(0u), high = uvec3(0u);
    if (subgroupElect()) {
      for (uint k = 0u; k < 3u; ++k) {
        uint l = all[k] & 0xffffu, h = all[k] >> 16u;
        uint word = length_word(queue, wave.bounce) + 2u * k;
        if (l > 0u) low[k] = atomicAdd(counters[word], l);
        if (h > 0u) high[k] = atomicAdd(counters[word + 1u], h);
      }
    }
    low = subgroupBroadcastFirst(low) + (before & 0xffffu);
    high = subgroupBroadcastFirst(high) + (before >> 16u);
    for (uint k = 0u; k < kRaysPerLane; ++k) {
      uint queues = hit_ids[(begin + k) % kRaysPerGroup], slot = load_queue(wave.ray_queue, begin + k);
      uint q = surface_queue(queues) - queue;
      bvec3 pair = equal(uvec3(q >> 1u), uvec3(0u, 1u, 2u));
      bool odd = (q & 1u) != 0u;
      uvec3 at = odd ? high : low;
      if (q < 6u) store_queue(queue + q, pair.x ? at.x : (pair.y ? at.y : at.z), slot);
      uvec3 step = uvec3(pair);
      low += odd ? uvec3(0u) : step;
      high += odd ? step : uvec3(0u);
      if (has_area_light() && queue == kQueueEmitter && goes_to_emitter(queues)) {
        store_queue(kQueueEmitter, low.x, slot);
        low.x += 1u;
      }
    }
  }
}

void main() {
  uint first = first_ray_in_group();
  RayList list = list_rays(wave.ray_queue, first, kCounterClosestTotal);
  trace_rays(first, first + trace_walls(first, list.count, false), false);
  report_unfinished(rays_unfinished);
  if (has_media()) return;  // sample_medium sorts

  subgroupMemoryBarrierShared();
  subgroupBarrier();
  sort_paths(first_place(first), list.mask);
}
