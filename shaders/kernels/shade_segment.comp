// A shadow ray from each ray's way through a homogeneous medium towards a light without extent: its single scattering
// there, whether or not the path collides. shade_medium leaves these lights out.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/queues.glsl"
#include "medium/medium.glsl"
#include "medium/phase.glsl"
#include "path/path_sampler.glsl"
#include "path/segment_light.glsl"
#include "path/volume_path.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  bool owned = i < queue_length(wave.ray_queue);
  uint slot = owned ? load_queue(wave.ray_queue, i) : kNoPath;
  bool live = slot != kNoPath;
  slot = live ? slot : 0u;
  vec3 o = load_path(kPathOrigin, slot).xyz, d = load_path(kPathDirection, slot).xyz;
  vec3 beta = load_path(kPathBeta, slot).xyz;
  float tmax = load_path(kPathHit, slot).w;
  VolumePath path = load_volume_path(slot);
  bool inside = live && path.medium != kNoMedium && path.edges < max_depth && tmax > 0.0;
  uint row = (inside ? path.medium : 0u) * kMediumRows;
  vec4 row0 = load_medium(row);
  vec3 sigma_t = row0.xyz, scattered = beta * load_medium(row + 1u).xyz * sigma_t;
  float sum = scattered.x + scattered.y + scattered.z;
  inside = inside && !is_grid(row0) && sum > 0.0;

  uvec2 pixel;
  pixel_of(slot_tile_pixel(slot), pixel);
  PathSampler s = begin_path_sampler(film_pixel(pixel), slot_sample(slot), params.seed);
  uvec4 bits = sample_group(sampler_kind, s.key, s.index, group_medium(wave.bounce), log2_samples);
  vec3 weights = has_medium(kMediaChromatic) ? scattered / sum : vec3(1.0, 0.0, 0.0);
  SegmentSample segment =
      sample_segment(o, d, inside ? tmax : 1.0, weights, sigma_t, open_unit(bits.z), unit_float(bits.w));
  vec3 wi = segment.to_light * inversesqrt(dot(segment.to_light, segment.to_light));
  float phase = eval_phase(load_phase(inside ? path.medium : 0u), d, wi);
  vec3 contribution = scattered * xexp(-sigma_t * segment.t) * segment.irradiance * (phase / segment.pdf);
  bool wanted = inside && segment.pdf > 0.0 && contribution != vec3(0.0);
  if (wanted && !is_finite(contribution)) {
    atomicAdd(counters[kCounterNonfinite], 1u);
    wanted = false;
  }
  if (wanted)
    store_volume_shadow_ray(i, o + segment.t * d, kNoHit, segment.to_light, kTargetPoint, contribution, slot,
                            path.medium);
  if (owned) store_queue(kQueueShadow, i, wanted ? slot : kNoPath);
}
