// One vertex of a path on a surface: next-event estimation and the next ray. Shared by the stage shade_surface and
// the kernel that follows whole paths.
#ifndef TACHYLITE_PATH_SURFACE_VERTEX_GLSL
#define TACHYLITE_PATH_SURFACE_VERTEX_GLSL
#include "base/features.glsl"
#include "geometry/surface.glsl"
#include "bsdf/bsdf.glsl"
#include "light/light.glsl"
#include "path/mis.glsl"
#include "path/path_sampler.glsl"
#include "path/termination.glsl"
#include "shared/path_state.h"
// Only diffuse surfaces are guided.
#if defined(BSDF_SINGLE_LEAF) && BSDF_TYPES == 2 && !defined(BAKED_COUNT)
#define IF_GUIDED(code) if (has_guide) { code }
#include "path/guide.glsl"

// density: of all ways to sample the direction, w.r.t. that of the bsdf.
BsdfSample sample_guided(GuideCell cell, SurfaceBsdf bsdf, vec2 u, out float density) {
  uint focuser = choose_focuser(cell.shares, u.x);
  bool focused = focuser < focuser_count;
  u = guide_numbers(focused ? focuser_table(cell, focuser) : cell.first, u).u;
  BsdfSample s = sample_bsdf(bsdf, u, 0.0);
  if (focused) {
    s.wi = focus_direction(focus_cone(cell, focuser), u);
    BsdfEval eval = eval_bsdf(bsdf, s.wi);
    s.weight = eval.pdf > 0.0 ? eval.f / eval.pdf : vec3(0.0);
    s.pdf = eval.pdf;
  }
  density = s.pdf > 0.0 ? guided_pdf(cell, s.wi, to_leaf(bsdf.leaf, s.wi), s.pdf) / s.pdf : 1.0;
  return s;
}
#else
#define IF_GUIDED(code)
#endif

// A ray towards a sampled light; `contribution` counts if nothing lies in between.
struct ShadowRay {
  bool wanted;
  vec3 o, d;           // shared/path_state.h: the light is at o + d
  uint target;
  vec3 contribution;
};

struct NextRay {
  bool alive;
  bool is_null;        // straight on, as if there were no surface
  vec3 o, d;
  float pdf;           // [1/sr], 0 after a delta lobe
  vec4 beta;           // throughput; w: eta^2 of refractions, to be undone in roulette
};

ShadowRay no_shadow_ray() { return ShadowRay(false, vec3(0.0), vec3(0.0), 0u, vec3(0.0)); }

// Whether the vertex of a path with `edges` edges samples a light.
bool samples_lights(uint edges) {
  return !is_photon_pass && light_selection != kSelectNone && strategy != kStrategyBsdf && has_material(kMaterialSmooth) &&
         edges < max_depth;
}

// The normal of the side that light may come from: the viewer's, unless some lobe transmits or has a normal of its own
// (then 0: any side).
vec3 light_side_normal(Interaction it, vec3 wo) {
  bool any_side = has_bsdf(kBsdfRoughDielectric) || has_bsdf(kBsdfPrincipled) || has_bsdf(kBsdfPrincipledThin) ||
                  has_material(kMaterialHasFrames);
  return any_side ? vec3(0.0) : (dot(it.n_s, wo) < 0.0 ? -it.n_s : it.n_s);
}

// u: point on the light; u_select: which light.
ShadowRay sample_direct_light(Interaction it, vec3 wo, SurfaceBsdf bsdf, vec3 beta, vec2 u, float u_select,
                              out float selection_key) {
  LightSample light = sample_light(it.p, light_side_normal(it, wo), u, u_select, selection_key);
  BsdfEval eval = eval_bsdf(bsdf, light.wi);
  IF_GUIDED(eval.pdf *= find_guide_cell(it.p, bsdf.leaf.n).shares.w;)
  float weight = light.delta || strategy == kStrategyEmitter ? 1.0 : mis_weight(light.pdf, eval.pdf);
  ShadowRay ray;
  ray.contribution = beta * eval.f * light.radiance * (weight / light.pdf);
  ray.wanted = light.pdf > 0.0 && ray.contribution != vec3(0.0);
  ray.target = light.target;
  ray.o = offset_origin(it, wo, light.wi);
  // Aim from the offset origin at the same target.
  ray.d = light.target == kTargetInfinite ? light.wi : (it.p - ray.o) + light.to_light;
  return ray;
}

// Whether vertices need the numbers of choice_sample.
bool needs_choices() { return has_roulette() || light_selection > kSelectSingle || !only_single_lobes(); }

// The next ray of a path with `edges` edges. u: direction; u_lobe, u_roulette: choices.
NextRay sample_next_ray(Interaction it, vec3 wo, SurfaceBsdf bsdf, vec4 beta, uint edges, vec2 u, float u_lobe,
                        float u_roulette) {
  float density = 1.0, mis_density = 1.0;  // of guiding, w.r.t. that of the bsdf; what the weights of MIS go by
  bool guided = false;
  BsdfSample s;
  IF_GUIDED(if (!is_photon_pass) {
    GuideCell cell = find_guide_cell(it.p, bsdf.leaf.n);
    s = sample_guided(cell, bsdf, u, density);
    mis_density = cell.shares.w;
    guided = true;
  })
  if (!guided) s = sample_bsdf(bsdf, u, u_lobe);
  NextRay ray;
  // Roulette is played as without the guide: where that sends many paths, they would end too soon.
  ray.beta = vec4(beta.xyz * s.weight / density, beta.w * s.eta * s.eta * density);
  ray.alive = ray.beta.xyz != vec3(0.0);
  if (has_roulette() && edges >= roulette_depth) {
    float q = survival_probability(ray.beta);
    ray.alive = ray.alive && u_roulette < q;
    ray.beta.xyz /= q;
  }
  ray.o = offset_origin(it, wo, s.wi);
  ray.d = s.wi;
  ray.pdf = s.pdf * mis_density;
  ray.is_null = (s.flags & kLobeNull) != 0u;
  return ray;
}

#endif
