// One bounce on a surface of one material class: a shadow ray towards a sampled light, and the next ray.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "base/queues.glsl"
#include "geometry/load.glsl"
#include "path/surface_vertex.glsl"
#include "path/volume_path.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  bool live = i < queue_length(kQueueSurface + material_class);
  uint place = place_of(kQueueSurface + material_class, i);
  uint slot = live ? load_queue(kQueueSurface + material_class, i) : 0u;
  vec4 direction = load_path(kPathDirection, slot);
  vec3 d = direction.xyz;
  vec4 beta = load_path(kPathBeta, slot);
  vec4 hit = load_path(kPathHit, slot);
  vec3 o = has_curved || is_photon_pass ? load_path(kPathOrigin, slot).xyz : vec3(0.0);
  Interaction it = load_interaction(hit, o, d);
  SurfaceBsdf bsdf = load_bsdf(it, -d);
  uvec2 pixel;
  pixel_of(slot_tile_pixel(slot), pixel);
  PathSampler path_sampler = begin_path_sampler(film_pixel(pixel), slot_sample(slot), params.seed);
  vec4 choices = needs_choices() ? choice_sample(path_sampler, wave.bounce) : vec4(0.0);
  VolumePath path = load_volume_path(slot);
  uint edges = path.edges;
  uvec4 shape = is_volumetric() ? load_shape(it.shape) : uvec4(0u);

  // What light samples find anyhow is not learned.
  IF_GUIDED(if (is_photon_pass)
    deposit_photon(live && edges > 1u, find_guide_cell(it.p, bsdf.leaf.n), o, d, to_leaf(bsdf.leaf, -d),
                   (beta.x + beta.y + beta.z) * (1.0 / 3.0), direction.w == 0.0 || direction.w > kFocusedPdf);)

  // Both rays before what is stored of either: their arithmetic overlaps in a CPU.
  bool may_be_lit = samples_lights(is_volumetric() ? 1u : edges), lit = false;
  float selection_key = 0.0;
  ShadowRay shadow_ray = no_shadow_ray();
  if (may_be_lit) {
    vec2 u = light_point_sample(path_sampler, edges - 1u);
    shadow_ray = sample_direct_light(it, -d, bsdf, beta.xyz, u, choices.x, selection_key);
    lit = live && shadow_ray.wanted && samples_lights(edges);
  }
  bool alive = false, passes = false;
  NextRay ray;
  if (is_volumetric() || goes_on(edges)) {
    vec2 u = direction_sample(path_sampler, edges - 1u).xy;
    ray = sample_next_ray(it, -d, bsdf, beta, edges, u, choices.y, choices.z);
    passes = is_volumetric() && ray.is_null;  // the edge goes on
    alive = live && ray.alive && (passes || goes_on(edges));
  }
  bool lost_light = lit && !is_finite(shadow_ray.contribution), lost_path = alive && !is_finite(ray.beta.xyz);
  if (lost_light || lost_path) atomicAdd(counters[kCounterNonfinite], uint(lost_light) + uint(lost_path));
  lit = lit && !lost_light;
  alive = alive && !lost_path;

  // Also where there is no light: only the queue tells, and CPUs would mispredict which lanes to leave out.
  if (may_be_lit && live)
    store_volume_shadow_ray(place, shadow_ray.o, floatBitsToUint(hit.x), shadow_ray.d, shadow_ray.target,
                            shadow_ray.contribution, slot, medium_behind(shape, it.n_g, shadow_ray.d, path.medium));
  if (has_shadow_rays() && live) store_queue(kQueueShadow, place, lit ? slot : kNoPath);
  if (alive) {
    store_path_ray(slot, ray.o, floatBitsToUint(hit.x), ray.d, passes ? direction.w : ray.pdf);
    store_path(kPathBeta, slot, ray.beta);
    store_volume_path(slot, VolumePath(medium_behind(shape, it.n_g, ray.d, path.medium), edges + (passes ? 0u : 1u),
                                       passes ? path.distance + hit.w : 0.0));
    if ((light_selection == kSelectLoop || light_selection == kSelectTree) && !passes)
      store_path(kPathRadiance, slot, vec4(load_path(kPathRadiance, slot).xyz, selection_key));
  }
  if (live) store_queue(1u - wave.ray_queue, place, alive ? slot : kNoPath);
}
