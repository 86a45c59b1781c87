// Adds the contribution of each shadow ray times what passes the media and null surfaces on its way. Rays go from one
// surface to the next in rounds: all of a subgroup are traced, then all are attenuated, so that no lane waits for a ray
// that is longer or crosses more.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define WALKS_GRIDS
#include "base/queues.glsl"
#include "geometry/load.glsl"
#include "geometry/surface.glsl"
#include "geometry/bvh.glsl"
#include "bsdf/null_transmission.glsl"
#include "medium/medium.glsl"
#include "path/listed_rays.glsl"
#include "path/path_sampler.glsl"

// What is left of a ray after null surfaces is stored in its place; what was stored must be read as it was written.
layout(set = 0, binding = kBindShadow) buffer ShadowState { vec4 shadow_state[]; };
vec4 load_state(uint row, uint place) {
  return shadow_passes_null ? shadow_state[row_index(row, place)] : load_shadow(row, place);
}

// What the rays of this workgroup's places have met.
shared vec4 hits[kRaysPerGroup];

TraceRay load_ray(uint place) {
  vec4 o = load_state(0u, place), d = load_state(1u, place);
  uint target = floatBitsToUint(d.w);
  return TraceRay(o.xyz, d.xyz, target == kTargetInfinite ? infinity() : 1.0, floatBitsToUint(o.w), target);
}
Traversal begin_ray(uint place, const bool any) { return begin_traversal(load_ray(place)); }
void end_ray(uint place, TraceHit hit, const bool any) {
  hits[place % kRaysPerGroup] = vec4(uintBitsToFloat(hit.id), hit.b1, hit.b2, hit.t);
}
#include "geometry/trace_rays.glsl"

// Numbers of the walks through grids.
WalkRandom walk_random(uint slot, uint crossings) {
  uvec2 pixel;
  pixel_of(slot_tile_pixel(slot), pixel);
  PathSampler s = begin_path_sampler(film_pixel(pixel), slot_sample(slot), params.seed);
  WalkRandom random = WalkRandom(s.key, s.index, 2u * wave.bounce + 1u + 0x10000u * crossings);
  random.key ^= wave.mode == kPrepareShadow ? 0x85ebca6bu : 0x9e3779b9u;
  return random;
}

// Attenuates a ray up to what it has met. Whether it goes on behind that; else what is left of it is added.
bool pass_segment(uint place, uint crossings) {
  TraceRay ray = load_ray(place);
  vec4 contribution = load_state(2u, place), hit = hits[place % kRaysPerGroup];
  uint slot = floatBitsToUint(contribution.w), medium = floatBitsToUint(load_state(3u, place).x);
  bool infinite = ray.ignored_target == kTargetInfinite, met = floatBitsToUint(hit.x) != kNoHit;
  bool reached = !met;
  vec3 transmittance = vec3(1.0), depth = vec3(0.0);
  if (!shadow_passes_null) transmittance = met ? vec3(0.0) : transmittance;
  vec3 o = ray.o, d = ray.d;
  uint behind = medium;
  if (shadow_passes_null && met) {
    Interaction it = load_interaction(hit, ray.o, ray.d);
    vec3 wo = -normalize(ray.d);
    transmittance = it.material != kNoIndex ? null_transmission_bsdf(it.material, it.point, it.n_s, wo) : vec3(0.0);
    behind = medium_behind(load_shape(it.shape), it.n_g, ray.d, medium);
    o = offset_origin(it, wo, ray.d);
    d = infinite ? ray.d : ray.o + ray.d - o;
    // A light on the surface is reached.
    reached = !infinite && !(dot(d, ray.d) > 0.0);
  }
  bool passes = transmittance != vec3(0.0), overflow = false;
  if (has_media()) {
    bool inside = medium != kNoMedium && passes;
    attenuate(inside ? medium : 0u, ray.o, ray.d, inside ? hit.w : 0.0, walk_random(slot, crossings), depth,
              transmittance, overflow);
  }
  contribution.xyz *= transmittance * xexp(-depth);
  bool goes_on = shadow_passes_null && !reached && contribution.xyz != vec3(0.0);
  if (goes_on && crossings + 1u == kMaxCrossings) {
    goes_on = false;
    overflow = true;
  }
  if (overflow) atomicAdd(counters[kCounterOverflow], 1u);
  if (reached && contribution.xyz != vec3(0.0)) add_radiance(slot, contribution.xyz);
  if (goes_on) {
    shadow_state[row_index(0u, place)] = vec4(o, hit.x);
    shadow_state[row_index(1u, place)] = vec4(d, uintBitsToFloat(ray.ignored_target));
    shadow_state[row_index(2u, place)] = contribution;
    shadow_state[row_index(3u, place)].x = uintBitsToFloat(behind);
  }
  return goes_on;
}

// Passes the `count` rays listed from `first` on through a segment; returns how many go on: these are then listed.
uint pass_segments(uint first, uint count, uint crossings) {
  uint left = 0u;
  for (uint k = 0u; k < count; k += gl_SubgroupSize) {
    uint i = k + gl_SubgroupInvocationID, place = 0u;
    bool goes_on = false;
    if (i < count) {
      place = listed[first + i];
      goes_on = pass_segment(place, crossings);
    }
    keep_listed(goes_on, place, first, left);
  }
  return left;
}

// No subgroupBarrier in the loop, which subgroups leave at different times (shaders/README.md): lanes wait for each
// other at ballots.
void main() {
  uint first = first_ray_in_group();
  uint count = list_rays(kQueueShadow, first).count;
  count_rays(kCounterShadowTotal, count);
  for (uint crossings = 0u; count > 0u && crossings < kMaxCrossings; ++crossings) {
    trace_rays(first, first + count, !shadow_passes_null);
    subgroupMemoryBarrier();
    rays_unfinished = subgroupBallot(rays_unfinished) != uvec4(0u);
    count = pass_segments(first, count, crossings);
    subgroupMemoryBarrier();
  }
  report_unfinished(rays_unfinished || count > 0u);
}
