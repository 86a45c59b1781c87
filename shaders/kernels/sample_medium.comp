// Flies each ray through the medium that it is in, and sorts the paths into the queues of the stages that follow:
// collisions in media, or what the ray has met at its end.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define WALKS_GRIDS
#include "base/queues.glsl"
#include "medium/medium.glsl"
#include "path/listed_rays.glsl"
#include "path/path_sampler.glsl"
#include "path/sort_paths.glsl"
#include "path/termination.glsl"
#include "path/volume_path.glsl"

// Lists those of the `count` rays listed from `first` on that are inside of media; returns how many. Of the others it
// tells where their paths go.
uint list_rays_inside(uint first, uint count) {
  uint inside = 0u;
  for (uint k = 0u; k < count; k += gl_SubgroupSize) {
    uint i = k + gl_SubgroupInvocationID;
    uint place = listed[first + min(i, count - 1u)];
    uint slot = load_queue(wave.ray_queue, place);
    VolumePath path = load_volume_path(slot);
    bool is_inside = i < count && path.medium != kNoMedium;
    keep_listed(is_inside, place, first, inside);
    if (i < count && !is_inside) {
      vec4 hit = load_path(kPathHit, slot);
      destinations[place % kRaysPerGroup] = queues_after(floatBitsToUint(hit.x), path.edges);
    }
  }
  subgroupMemoryBarrierShared();
  subgroupBarrier();
  return inside;
}

void fly(bool live, uint place) {
  uint slot = load_queue(wave.ray_queue, place);
  vec3 o = load_path(kPathOrigin, slot).xyz, d = load_path(kPathDirection, slot).xyz;
  vec4 beta = load_path(kPathBeta, slot), hit = load_path(kPathHit, slot);
  VolumePath path = load_volume_path(slot);
  uvec2 pixel;
  pixel_of(slot_tile_pixel(slot), pixel);
  PathSampler s = begin_path_sampler(film_pixel(pixel), slot_sample(slot), params.seed);
  uvec4 bits = sample_group(sampler_kind, s.key, s.index, group_medium(wave.bounce), log2_samples);
  WalkRandom random = WalkRandom(s.key, s.index, 2u * wave.bounce);
  bool overflow = false;
  FreeFlight flight = fly_medium(path.medium, o, d, live ? hit.w : 0.0, beta.xyz, bits.xy, random, overflow);
  if (live && overflow) atomicAdd(counters[kCounterOverflow], 1u);

  bool collides = live && flight.collides;
  if (live) store_path(kPathBeta, slot, vec4(flight.beta, beta.w));
  if (collides) store_path(kPathHit, slot, vec4(uintBitsToFloat(kNoHit), 0.0, 0.0, flight.t));
  uint queues = collides ? (path.edges < max_depth ? kQueueSurface + class_count : kNoQueues)
                         : queues_after(floatBitsToUint(hit.x), path.edges);
  if (live) destinations[place % kRaysPerGroup] = flight.beta != vec3(0.0) ? queues : kNoQueues;
}

uint destination(uint place) { return destinations[place % kRaysPerGroup]; }

void main() {
  uint first = first_ray_in_group();
  RayList list = list_rays(wave.ray_queue, first);
  uint inside = list_rays_inside(first, list.count);
  for (uint k = 0u; k < inside; k += gl_SubgroupSize) {
    uint i = k + gl_SubgroupInvocationID;
    fly(i < inside, listed[first + min(i, inside - 1u)]);
  }
  subgroupMemoryBarrierShared();
  subgroupBarrier();
  sort_paths(first_place(first), list.mask);
}
