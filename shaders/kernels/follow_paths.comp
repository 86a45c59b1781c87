// Whole paths of a tiny scene in one kernel, without queues: a lane renders the wave's samples of one pixel, one path
// after the other. Kernels with more primitives are variants with another BAKED_COUNT.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#ifndef BAKED_COUNT
#define BAKED_COUNT 24
#endif
#define LIGHT_IN_REGISTERS
#include "base/queues.glsl"
#include "geometry/baked.glsl"
#include "geometry/load.glsl"
#include "path/camera.glsl"
#include "path/surface_vertex.glsl"

layout(set = 0, binding = kBindBaked) uniform samplerBuffer baked;
layout(set = 0, binding = kBindFilm) writeonly restrict buffer Film { vec4 film[]; };

vec4 load_baked(uint primitive, uint row) { return texelFetch(baked, int(primitive * kBakedRows + row)); }

Interaction baked_interaction(uint primitive, BakedRay ray, float t, out uint hit_id) {
  vec4 plane = load_baked(primitive, 0u);
  uvec4 names = floatBitsToUint(load_baked(primitive, 1u));
  hit_id = names.w;
  Interaction it;
  it.p = ray.o + t * ray.d;
  if (has_curved && names.z == kNoIndex) {
    vec3 n = normalize(it.p - plane.xyz);
    it.p = plane.xyz + abs(plane.w) * n;
    it.n_g = plane.w < 0.0 ? -n : n;
    it.p_error = kGammaCurved * (abs(plane.xyz) + abs(plane.w));
  } else {
    it.n_g = plane.xyz;
    it.p -= it.n_g * (dot(it.n_g, it.p) + plane.w);
    it.p_error = kGammaPlane * (abs(it.p) + abs(plane.w * it.n_g));
  }
  it.n_s = it.n_g;
  it.dp_du = it.dp_dv = vec3(0.0);
  it.point = TexturePoint(vec2(0.0), names.z, vec2(0.0));
  it.material = names.x;
  it.light = names.y;
  it.shape = kNoIndex;
  set_shading_frame(it);
  return it;
}

void main() {
  hoist_light();
  uint i = gl_GlobalInvocationID.x;
  uvec2 pixel = uvec2(0u);
  bool going = i < wave.pixel_count && pixel_of(wave_pixel(i), pixel);
  uint key = pixel_key(film_pixel(pixel), params.seed);

  uint first_block = wave_block(i), index = first_block * kBlockSamples;
  uint end = min(index + wave.block_count * kBlockSamples, params.end_sample);
  PathSampler path_sampler = PathSampler(key, index);
  vec4 u_camera = camera_sample(path_sampler);
  CameraRay camera = sample_camera_ray(pixel, u_camera.xy, path_sampler);
  BakedRay ray = BakedRay(camera.o, camera.d, kNoHit, kNoHit);
  float tmax = camera.tmax, pdf = 0.0, selection_key = 0.0;
  vec4 beta = vec4(1.0);
  vec3 radiance = vec3(0.0), sum = vec3(0.0);
  vec2 u_light = u_camera.zw;
  uint edges = 1u, closest_rays = 0u, shadow_rays = 0u, nonfinite = 0u;

  while (going) {
    float t = tmax;
    uint primitive = closest_baked(ray, t);
    closest_rays += 1u;
    bool is_hit = primitive != kNoIndex;
    uint hit_id;
    Interaction it = baked_interaction(is_hit ? primitive : 0u, ray, t, hit_id);
    bool alive = is_hit && it.material != kNoIndex;
    it.material = alive ? it.material : 0u;

    // Light that the ray has found.
    if (is_hit && it.light != kNoIndex) {
      vec3 emitted = emitted_radiance(it, -ray.d);
      float light_pdf = pdf_light_hit(ray.o, selection_key, it, hit_id, ray.d, t);
      if (emitted != vec3(0.0)) radiance += found_light_weight(pdf, light_pdf) * beta.xyz * emitted;
    }
    if (has_escaped_light() && !is_hit) {
      float light_pdf = pdf_light_escaped(ray.o, selection_key, ray.d);
      radiance += found_light_weight(pdf, light_pdf) * beta.xyz * escaped_radiance(ray.d);
    }

    SurfaceBsdf bsdf = load_bsdf(it, -ray.d);
    vec4 choices = needs_choices() ? choice_sample(path_sampler, edges - 1u) : vec4(0.0);
    if (samples_lights(edges)) {
      ShadowRay shadow = sample_direct_light(it, -ray.d, bsdf, beta.xyz, u_light, choices.x, selection_key);
      BakedRay to_light = BakedRay(shadow.o, shadow.d, hit_id, shadow.target);
      bool wanted = alive && shadow.wanted;
      bool blocked = any_baked(to_light, shadow.target == kTargetInfinite ? infinity() : 1.0);
      radiance += wanted && !blocked ? shadow.contribution : vec3(0.0);
      shadow_rays += wanted ? 1u : 0u;
    }

    alive = alive && goes_on(edges);
    if (goes_on(edges)) {
      vec4 u = direction_sample(path_sampler, edges - 1u);
      u_light = u.zw;
      NextRay next = sample_next_ray(it, -ray.d, bsdf, beta, edges, u.xy, choices.y, choices.z);
      alive = alive && next.alive;
      ray = BakedRay(next.o, next.d, hit_id, kNoHit);
      pdf = next.pdf;
      beta = next.beta;
      tmax = infinity();
    }
    edges += 1u;

    if (!alive) {
      // Add the path to its block, and begin the next.
      bool fits = is_finite(radiance);
      sum += fits ? radiance : vec3(0.0);
      nonfinite += fits ? 0u : 1u;
      index += 1u;
      going = index < end;
      if (index % kBlockSamples == 0u || !going) {
        uint block = (index - 1u) / kBlockSamples - first_block;
        film[block * wave.pixel_count + i] = vec4(sum, 0.0);
        sum = vec3(0.0);
      }
      path_sampler = PathSampler(key, index);
      u_camera = camera_sample(path_sampler);
      camera = sample_camera_ray(pixel, u_camera.xy, path_sampler);
      ray = BakedRay(camera.o, camera.d, kNoHit, kNoHit);
      tmax = camera.tmax;
      pdf = 0.0;
      beta = vec4(1.0);
      radiance = vec3(0.0);
      u_light = u_camera.zw;
      edges = 1u;
    }
  }
  report_unfinished(going);
  add_to_counter(kCounterClosestTotal, closest_rays);
  add_to_counter(kCounterShadowTotal, shadow_rays);
  add_to_counter(kCounterNonfinite, nonfinite);
}
