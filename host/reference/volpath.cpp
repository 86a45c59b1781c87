// Volumetric path tracing, as Mitsuba's integrators volpath and volpathmis (one expectation):
//  - depth counts surfaces and collisions in media, not null lobes (null, the open part of masks, thin
//  dielectrics
//    straight through); limits and Russian roulette as in path.cpp;
//  - shadow rays pass null lobes, with their transmission, and media, with their transmittance; so what a ray
//  hits
//    after passing null lobes is weighted against light sampling from the last vertex that changed its
//    direction;
//  - the medium changes at every surface that names an interior or exterior one, to the one on the side that
//  the
//    ray goes to, scattered or not.

#include "reference/medium/phase_function.h"
#include "reference/world.h"

namespace tachylite::reference {
namespace {

/// The medium beyond a surface crossed or left in direction d.
MediumIndex medium_behind(const World& world, const SurfacePoint& surface, const dvec3& d,
                          MediumIndex current) {
  const Shape& shape = world.shape_of(surface);
  if (!shape.is_medium_boundary) return current;
  return glm::dot(surface.n_g, d) > 0 ? shape.exterior : shape.interior;
}

/// Transmission of a shadow ray through null lobes and media.
dvec3 shadow_transmission(const World& world, Ray ray, MediumIndex medium, Random& random,
                          World::Counters& counters) {
  // Steps off crossed surfaces must not carry the end of the ray into the light that it stops short of.
  const bool infinite = ray.t_max == kInfinity;
  const dvec3 end = infinite ? dvec3(0) : ray.origin + ray.t_max * ray.direction;
  dvec3 result(1);
  while (!is_black(result)) {
    ++counters.shadow_rays;
    const auto hit = world.geometry.intersect(ray);
    if (medium != kNone) {
      const Ray segment{ray.origin, ray.direction, hit ? hit->t : ray.t_max};
      result *= world.media.transmittance(medium, segment, random);
    }
    if (!hit) break;
    const dvec3 wo = hit->frame.to_local(-glm::normalize(ray.direction));
    result *= null_transmission(world.shape_of(*hit).bsdf, shading_point(world.materials, *hit), wo);
    medium = medium_behind(world, *hit, ray.direction, medium);
    ray.origin = hit->offset_towards(ray.direction);
    if (infinite) continue;
    if (glm::dot(end - ray.origin, ray.direction) <= 0) break;
    ray.direction = end - ray.origin;
    ray.t_max = 1;
  }
  return result;
}

}  // namespace

dvec3 trace_volpath(const World& world, const Ray& camera_ray, MediumIndex medium, Random& random,
                    World::Counters& counters) {
  const Integrator& integrator = world.scene.integrator;
  const bool sample_lights = integrator.strategy != Integrator::Strategy::kBsdfOnly;
  const bool only_lights = integrator.strategy == Integrator::Strategy::kEmitterOnly;
  dvec3 radiance(0), throughput(1);
  double eta = 1;
  Ray ray = camera_ray;
  int depth = 0;

  // The last vertex that chose a direction.
  dvec3 previous_p(0);
  double previous_pdf = 0;
  bool previous_smooth = false;
  const auto mis_weight = [&](double pdf_light) {
    if (!previous_smooth || !sample_lights) return 1.0;
    return only_lights ? 0.0 : power_heuristic(previous_pdf, pdf_light);
  };
  /// Direct light at a vertex; scatter gives f |cos| and the density of sampling a direction.
  const auto add_direct_light = [&](const dvec3& p, const auto& origin, const auto& medium_towards,
                                    const auto& scatter) {
    const auto light = world.lights.sample_light(p, random);
    if (!light) return;
    const auto [f, pdf] = scatter(light->wi);
    if (is_black(f)) return;
    const Ray shadow = Lights::shadow_ray(origin(light->wi), *light);
    const dvec3 transmission =
        shadow_transmission(world, shadow, medium_towards(light->wi), random, counters);
    const double weight = light->delta || only_lights ? 1 : power_heuristic(light->pdf, pdf);
    radiance += throughput * f * light->weight * transmission * weight;
  };

  while (!is_black(throughput) && (integrator.max_depth < 0 || depth < integrator.max_depth)) {
    if (depth > integrator.rr_depth) {
      const double survival = std::min(max_component(throughput) * sqr(eta), 0.95);
      if (random.uniform() >= survival) break;
      throughput /= survival;
    }

    ++counters.closest_rays;
    const bool hide = integrator.hide_emitters && depth == 0;
    const auto hit = hide ? world.geometry.intersect_without_emitters(ray) : world.geometry.intersect(ray);

    // A collision in the medium.
    if (medium != kNone) {
      const Ray segment{ray.origin, ray.direction, hit ? hit->t : ray.t_max};
      const std::optional<double> collision =
          world.media.sample_free_flight(medium, segment, throughput, random);
      if (collision) {
        ++depth;
        if (is_black(throughput) || (integrator.max_depth >= 0 && depth >= integrator.max_depth)) break;
        const dvec3 p = ray.origin + *collision * ray.direction, wo = -ray.direction;
        const PhaseFunction& phase = world.media.phase(medium);
        if (sample_lights) {
          add_direct_light(
              p, [&](const dvec3&) { return p; }, [&](const dvec3&) { return medium; },
              [&](const dvec3& wi) {
                const double value = eval_phase(phase, wo, wi);
                return std::pair(dvec3(value), value);
              });
        }
        const dvec3 wi = sample_phase(phase, wo, random);
        ray = {p, wi};
        previous_p = p;
        previous_pdf = eval_phase(phase, wo, wi);
        previous_smooth = true;
        continue;
      }
    }

    // Emission.
    if (!hit) {
      const dvec3 le = hide ? dvec3(0) : world.lights.environment(ray.direction);
      if (!is_black(le))
        radiance += throughput * le * mis_weight(world.lights.pdf_environment(ray.direction));
      break;
    }
    const dvec3 le = world.lights.emitted(*hit, -ray.direction);
    if (!is_black(le)) radiance += throughput * le * mis_weight(world.lights.pdf_surface(previous_p, *hit));

    // A surface.
    const BsdfIndex bsdf = world.shape_of(*hit).bsdf;
    const ShadingPoint point = shading_point(world.materials, *hit);
    const dvec3 wo = hit->frame.to_local(-ray.direction);
    const bool may_light = integrator.max_depth < 0 || depth + 1 < integrator.max_depth;
    if (may_light && sample_lights && has_smooth_lobe(world.scene, bsdf)) {
      add_direct_light(
          hit->p, [&](const dvec3& wi) { return hit->offset_towards(wi); },
          [&](const dvec3& wi) { return medium_behind(world, *hit, wi, medium); },
          [&](const dvec3& wi_world) {
            const dvec3 wi = hit->frame.to_local(wi_world);
            return std::pair(eval_bsdf(bsdf, point, wo, wi), pdf_bsdf(bsdf, point, wo, wi));
          });
    }
    const auto sample = sample_bsdf(bsdf, point, wo, random);
    if (!sample) break;
    throughput *= sample->weight;
    eta *= sample->eta;
    ray = hit->spawn_ray(hit->frame.to_world(sample->wi));
    if (!goes_straight(sample->kind)) {
      ++depth;
      previous_p = hit->p;
      previous_pdf = sample->pdf;
      previous_smooth = sample->kind == Scattering::kSmooth;
    }
    medium = medium_behind(world, *hit, ray.direction, medium);
  }
  return radiance;
}

}  // namespace tachylite::reference
