// Adds the contribution of each shadow ray times what passes the media and null surfaces on its way.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/queues.glsl"
#include "geometry/load.glsl"
#include "geometry/surface.glsl"
#include "geometry/bvh.glsl"
#include "bsdf/null_transmission.glsl"
#include "medium/medium.glsl"
#include "path/path_sampler.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  uint slot = i < queue_length(kQueueShadow) ? load_queue(kQueueShadow, i) : kNoPath;
  add_to_counter(kCounterShadowTotal, slot != kNoPath ? 1u : 0u);
  if (slot == kNoPath) return;
  vec4 o = load_shadow(0u, i), d = load_shadow(1u, i), c = load_shadow(2u, i);
  uint target = floatBitsToUint(d.w);
  uint medium = floatBitsToUint(load_shadow(3u, i).x);
  bool infinite = target == kTargetInfinite;
  vec3 end = o.xyz + d.xyz;
  TraceRay ray = TraceRay(o.xyz, d.xyz, infinite ? infinity() : 1.0, floatBitsToUint(o.w), target);

  uvec2 pixel;
  pixel_of(slot_tile_pixel(slot), pixel);
  PathSampler s = begin_path_sampler(film_pixel(pixel), slot_sample(slot), params.seed);
  WalkRandom random = WalkRandom(s.key, s.index, 2u * wave.bounce + 1u);
  random.key ^= wave.mode == kPrepareShadow ? 0x85ebca6bu : 0x9e3779b9u;

  vec3 depth = vec3(0.0), transmittance = vec3(1.0);
  bool overflow = false, going = true;
  uint crossings = 0u;
  while (going) {
    // Without null surfaces the first hit decides.
    TraceHit hit = trace_ray(ray, !shadow_passes_null);
    bool met = hit.id != kNoHit;
    if (has_media()) {
      bool inside = medium != kNoMedium && (shadow_passes_null || !met);
      float tmax = met ? hit.t : ray.tmax;
      attenuate(inside ? medium : 0u, ray.o, ray.d, inside ? tmax : 0.0, random, depth, transmittance, overflow);
    }
    if (shadow_passes_null) {
      if (met) {
        vec4 row = vec4(uintBitsToFloat(hit.id), hit.b1, hit.b2, hit.t);
        Interaction it = load_interaction(row, ray.o, ray.d);
        uvec4 shape = load_shape(it.shape);
        vec3 passed = vec3(0.0);
        vec3 wo = -normalize(ray.d);
        if (it.material != kNoIndex) passed = null_transmission_bsdf(it.material, it.point, it.n_s, wo);
        transmittance *= passed;
        medium = medium_behind(shape, it.n_g, ray.d, medium);
        ray.o = offset_origin(it, wo, ray.d);
        ray.d = infinite ? ray.d : end - ray.o;
        ray.ignored = hit.id;
        random.segment += 0x10000u;
        crossings += 1u;
      }
      // A light on the surface is reached.
      bool reached = met && !infinite && !(dot(ray.d, d.xyz) > 0.0);
      going = met && !reached && transmittance != vec3(0.0) && crossings < kMaxCrossings;
      if (met && !going && !reached) {
        overflow = overflow || transmittance != vec3(0.0);
        transmittance = vec3(0.0);
      }
    } else {
      transmittance = met ? vec3(0.0) : transmittance;
      going = false;
    }
  }
  report_unfinished(rays_unfinished || going);
  if (overflow) atomicAdd(counters[kCounterOverflow], 1u);
  if (transmittance != vec3(0.0)) add_radiance(slot, c.xyz * transmittance * xexp(-depth));
}
