// Flies each ray through the medium that it is in, and sorts the paths into the queues of the stages that follow:
// collisions in media, or what the ray has met at its end.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/queues.glsl"
#include "medium/medium.glsl"
#include "path/path_sampler.glsl"
#include "path/sort_path.glsl"
#include "path/termination.glsl"
#include "path/volume_path.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  uint slot = i < queue_length(wave.ray_queue) ? load_queue(wave.ray_queue, i) : kNoPath;
  if (slot == kNoPath) return;
  vec3 o = load_path(kPathOrigin, slot).xyz, d = load_path(kPathDirection, slot).xyz;
  vec4 beta = load_path(kPathBeta, slot), hit = load_path(kPathHit, slot);
  VolumePath path = load_volume_path(slot);
  bool inside = path.medium != kNoMedium;

  uvec2 pixel;
  pixel_of(slot_tile_pixel(slot), pixel);
  PathSampler s = begin_path_sampler(film_pixel(pixel), slot_sample(slot), params.seed);
  uvec4 bits = sample_group(sampler_kind, s.key, s.index, group_medium(wave.bounce), log2_samples);
  WalkRandom random = WalkRandom(s.key, s.index, 2u * wave.bounce);
  bool overflow = false;
  FreeFlight flight =
      fly_medium(inside ? path.medium : 0u, o, d, inside ? hit.w : 0.0, beta.xyz, bits.xy, random, overflow);
  if (inside && overflow) atomicAdd(counters[kCounterOverflow], 1u);

  bool collides = inside && flight.collides;
  if (inside) store_path(kPathBeta, slot, vec4(flight.beta, beta.w));
  if (collides) store_path(kPathHit, slot, vec4(uintBitsToFloat(kNoHit), 0.0, 0.0, flight.t));
  bool alive = !inside || flight.beta != vec3(0.0);
  append_to_queue(kQueueSurface + class_count, alive && collides && path.edges < max_depth, slot);
  sort_path(alive && !collides, slot, floatBitsToUint(hit.x), path.edges);
}
