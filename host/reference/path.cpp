// Path tracing (Kajiya 1986) with next-event estimation, as Mitsuba's integrators path and direct (max_depth
// 2):
//  - depth counts surfaces, null and masked ones included; an emitter hit at depth d counts if d < max_depth,
//  light
//    is sampled at depth d if d + 1 < max_depth;
//  - shadow rays are blocked by every surface, null and masked ones included; so a direction sampled from a
//  delta or
//    null lobe counts what it hits with full weight;
//  - Russian roulette from rr_depth on, with probability min(max throughput * eta^2, 0.95), eta the product
//  of the
//    relative indices crossed: the throughput without the factors 1/eta^2 of radiance;
//  - hide_emitters: camera rays pass shapes with emitters, and see no environment.
// Media are ignored.

#include "reference/world.h"

namespace tachylite::reference {

dvec3 trace_path(const World& world, const Ray& camera_ray, Random& random, World::Counters& counters) {
  const Integrator& integrator = world.scene.integrator;
  const bool sample_lights = integrator.strategy != Integrator::Strategy::kBsdfOnly;
  const bool only_lights = integrator.strategy == Integrator::Strategy::kEmitterOnly;
  dvec3 radiance(0), throughput(1);
  double eta = 1;
  Ray ray = camera_ray;

  // How the current ray was chosen.
  dvec3 previous_p(0);
  double previous_pdf = 0;
  bool previous_smooth = false;
  /// Weight of what the ray hits against light sampling with density pdf_light from the previous vertex.
  const auto mis_weight = [&](double pdf_light) {
    if (!previous_smooth || !sample_lights) return 1.0;
    return only_lights ? 0.0 : power_heuristic(previous_pdf, pdf_light);
  };

  for (int depth = 0; integrator.max_depth < 0 || depth < integrator.max_depth; ++depth) {
    ++counters.closest_rays;
    const bool hide = integrator.hide_emitters && depth == 0;
    const auto hit = hide ? world.geometry.intersect_without_emitters(ray) : world.geometry.intersect(ray);

    // Emission.
    if (!hit) {
      const dvec3 le = hide ? dvec3(0) : world.lights.environment(ray.direction);
      if (!is_black(le))
        radiance += throughput * le * mis_weight(world.lights.pdf_environment(ray.direction));
      break;
    }
    const dvec3 le = world.lights.emitted(*hit, -ray.direction);
    if (!is_black(le)) radiance += throughput * le * mis_weight(world.lights.pdf_surface(previous_p, *hit));
    if (integrator.max_depth >= 0 && depth + 1 >= integrator.max_depth) break;

    // Light sampling.
    const BsdfIndex bsdf = world.shape_of(*hit).bsdf;
    const ShadingPoint point = shading_point(world.materials, *hit);
    const dvec3 wo = hit->frame.to_local(-ray.direction);
    if (sample_lights && has_smooth_lobe(world.scene, bsdf)) {
      if (const auto light = world.lights.sample_light(hit->p, random)) {
        const dvec3 wi = hit->frame.to_local(light->wi);
        const dvec3 f = eval_bsdf(bsdf, point, wo, wi);
        if (!is_black(f)) {
          ++counters.shadow_rays;
          if (!world.geometry.occluded(Lights::shadow_ray(hit->offset_towards(light->wi), *light))) {
            const double weight =
                light->delta || only_lights ? 1 : power_heuristic(light->pdf, pdf_bsdf(bsdf, point, wo, wi));
            radiance += throughput * f * light->weight * weight;
          }
        }
      }
    }

    // Continue.
    const auto sample = sample_bsdf(bsdf, point, wo, random);
    if (!sample) break;
    throughput *= sample->weight;
    eta *= sample->eta;
    if (is_black(throughput)) break;
    ray = hit->spawn_ray(hit->frame.to_world(sample->wi));
    previous_p = hit->p;
    previous_pdf = sample->pdf;
    previous_smooth = sample->kind == Scattering::kSmooth;

    if (depth + 1 >= integrator.rr_depth) {
      const double survival = std::min(max_component(throughput) * sqr(eta), 0.95);
      if (random.uniform() >= survival) break;
      throughput /= survival;
    }
  }
  return radiance;
}

}  // namespace tachylite::reference
