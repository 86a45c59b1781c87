// A shadow ray from each ray's way through a homogeneous medium towards a light without extent: its single scattering
// there, whether or not the path collides. shade_medium leaves these lights out.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/queues.glsl"
#include "medium/medium.glsl"
#include "medium/phase.glsl"
#include "path/listed_rays.glsl"
#include "path/path_sampler.glsl"
#include "path/segment_light.glsl"
#include "path/volume_path.glsl"

// Lists those of the `count` rays listed from `first` on that go through homogeneous media; returns how many.
uint list_segments(uint first, uint count) {
  uint left = 0u;
  for (uint k = 0u; k < count; k += gl_SubgroupSize) {
    uint i = k + gl_SubgroupInvocationID;
    uint place = listed[first + min(i, count - 1u)], slot = load_queue(wave.ray_queue, place);
    VolumePath path = load_volume_path(slot);
    bool inside = i < count && path.medium != kNoMedium && path.edges < max_depth && load_path(kPathHit, slot).w > 0.0;
    inside = inside && !is_grid(load_medium((inside ? path.medium : 0u) * kMediumRows));
    keep_listed(inside, place, first, left);
  }
  return left;
}

void sample_ray(bool live, uint place) {
  uint slot = load_queue(wave.ray_queue, place);
  vec3 o = load_path(kPathOrigin, slot).xyz, d = load_path(kPathDirection, slot).xyz;
  vec3 beta = load_path(kPathBeta, slot).xyz;
  float tmax = load_path(kPathHit, slot).w;
  uint medium = load_volume_path(slot).medium, row = medium * kMediumRows;
  vec3 sigma_t = load_medium(row).xyz, scattered = beta * load_medium(row + 1u).xyz * sigma_t;
  float sum = scattered.x + scattered.y + scattered.z;

  uvec2 pixel;
  pixel_of(slot_tile_pixel(slot), pixel);
  PathSampler s = begin_path_sampler(film_pixel(pixel), slot_sample(slot), params.seed);
  uvec4 bits = sample_group(sampler_kind, s.key, s.index, group_medium(wave.bounce), log2_samples);
  vec3 weights = has_medium(kMediaChromatic) ? scattered / sum : vec3(1.0, 0.0, 0.0);
  SegmentSample segment = sample_segment(o, d, tmax, weights, sigma_t, open_unit(bits.z), unit_float(bits.w));
  vec3 wi = segment.to_light * inversesqrt(dot(segment.to_light, segment.to_light));
  float phase = eval_phase(load_phase(medium), d, wi);
  vec3 contribution = scattered * xexp(-sigma_t * segment.t) * segment.irradiance * (phase / segment.pdf);
  bool wanted = live && sum > 0.0 && segment.pdf > 0.0 && contribution != vec3(0.0);
  if (wanted && !is_finite(contribution)) {
    atomicAdd(counters[kCounterNonfinite], 1u);
    wanted = false;
  }
  if (wanted) {
    store_volume_shadow_ray(place, o + segment.t * d, kNoHit, segment.to_light, kTargetPoint, contribution, slot,
                            medium);
    store_queue(kQueueShadow, place, slot);
  }
}

void main() {
  uint first = first_ray_in_group(), begin = first_place(first), places = queue_length(wave.ray_queue);
  [[dont_unroll]] for (uint k = 0u; k < kRaysPerLane; ++k)
    if (begin + k < places) store_queue(kQueueShadow, begin + k, kNoPath);
  uint count = list_segments(first, list_rays(wave.ray_queue, first).count);
  subgroupMemoryBarrier();
  subgroupBarrier();
  for (uint k = 0u; k < count; k += gl_SubgroupSize) {
    uint i = k + gl_SubgroupInvocationID;
    sample_ray(i < count, listed[first + min(i, count - 1u)]);
  }
}
