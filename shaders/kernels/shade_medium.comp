// One collision in a medium: a shadow ray towards a sampled light, and the next ray by the phase function.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/queues.glsl"
#include "light/light.glsl"
#include "medium/phase.glsl"
#include "path/mis.glsl"
#include "path/path_sampler.glsl"
#include "path/termination.glsl"
#include "path/volume_path.glsl"

// shade_segment samples lights without extent in homogeneous media.
bool samples_lights_here() {
  bool others = has_area_light() || has_escaped_light() || has_light(kLightDirectional) || has_medium(kMediaGrids);
  return has_shadow_rays() && (others || !has_medium(kMediaSegments));
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  bool live = i < queue_length(kQueueSurface + class_count);
  uint place = place_of(kQueueSurface + class_count, i);
  uint slot = live ? load_queue(kQueueSurface + class_count, i) : 0u;
  vec3 d = load_path(kPathDirection, slot).xyz;
  vec3 p = load_path(kPathOrigin, slot).xyz + load_path(kPathHit, slot).w * d;
  vec4 beta = load_path(kPathBeta, slot);
  VolumePath path = load_volume_path(slot);
  uint row = (live ? path.medium : 0u) * kMediumRows;
  Phase phase = load_phase(live ? path.medium : 0u);
  uvec2 pixel;
  pixel_of(slot_tile_pixel(slot), pixel);
  PathSampler path_sampler = begin_path_sampler(film_pixel(pixel), slot_sample(slot), params.seed);
  vec4 choices = choice_sample(path_sampler, wave.bounce);
  uint vertex = path.edges - 1u;

  // As in shade_surface: both rays before what is stored of either, and shadow rays also where there is no light.
  float selection_key = 0.0;
  bool lit = false;
  LightSample light;
  vec3 contribution = vec3(0.0);
  if (samples_lights_here()) {
    vec2 u = light_point_sample(path_sampler, vertex);
    light = sample_light(p, vec3(0.0), u, choices.x, selection_key);
    float pdf = eval_phase(phase, d, light.wi);
    float weight = light.delta || strategy == kStrategyEmitter ? 1.0 : mis_weight(light.pdf, pdf);
    contribution = beta.xyz * pdf * light.radiance * (weight / light.pdf);
    lit = live && light.pdf > 0.0 && contribution != vec3(0.0);
    if (has_medium(kMediaSegments)) lit = lit && !(light.target == kTargetPoint && !is_grid(load_medium(row)));
  }
  vec3 wi = sample_phase(phase, d, direction_sample(path_sampler, vertex).xy, choices.y);
  float pdf = eval_phase(phase, d, wi);
  bool alive = live && goes_on(path.edges);
  if (has_roulette() && path.edges >= roulette_depth) {
    float q = survival_probability(beta);
    alive = alive && choices.z < q;
    beta.xyz /= q;
  }
  bool lost = lit && !is_finite(contribution);
  if (lost) atomicAdd(counters[kCounterNonfinite], 1u);
  lit = lit && !lost;

  if (samples_lights_here() && live)
    store_volume_shadow_ray(place, p, kNoHit, light.target == kTargetInfinite ? light.wi : light.to_light, light.target,
                            contribution, slot, path.medium);
  if (has_shadow_rays() && live) store_queue(kQueueShadow, place, lit ? slot : kNoPath);
  if (alive) {
    store_path_ray(slot, p, kNoHit, wi, pdf);
    store_path(kPathBeta, slot, beta);
    store_volume_path(slot, VolumePath(path.medium, path.edges + 1u, 0.0));
    if (light_selection == kSelectLoop || light_selection == kSelectTree)
      store_path(kPathRadiance, slot, vec4(load_path(kPathRadiance, slot).xyz, selection_key));
  }
  if (live) store_queue(1u - wave.ray_queue, place, alive ? slot : kNoPath);
}
