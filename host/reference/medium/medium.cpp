#include "reference/medium/medium.h"

#include "reference/medium/homogeneous.h"

namespace tachylite::reference {
namespace {

/// The part of a ray inside a box, as an interval of t; empty (begin > end) outside.
struct Interval {
  double begin, end;
};
Interval clip(const Ray& ray, const dvec3& low, const dvec3& high) {
  Interval result{0, ray.t_max};
  for (int k = 0; k < 3; ++k) {
    if (ray.direction[k] == 0) {
      if (ray.origin[k] < low[k] || ray.origin[k] > high[k]) return {1, 0};
      continue;
    }
    const double a = (low[k] - ray.origin[k]) / ray.direction[k],
                 b = (high[k] - ray.origin[k]) / ray.direction[k];
    result = {std::max(result.begin, std::min(a, b)), std::min(result.end, std::max(a, b))};
  }
  return result;
}

}  // namespace

Media::Media(const Scene& scene) : scene_(scene) {
  for (const Medium& medium : scene.media) {
    const auto* heterogeneous = std::get_if<HeterogeneousMedium>(&medium.kind);
    if (!heterogeneous) {
      grids_.push_back(nullptr);
      continue;
    }
    auto grids = std::make_unique<Grids>(Grids{GridVolume(heterogeneous->sigma_t),
                                               GridVolume(heterogeneous->albedo), heterogeneous->scale, 0});
    grids->majorant = grids->scale * grids->sigma_t.maximum();
    grids_.push_back(std::move(grids));
  }
}

std::optional<double> Media::sample_free_flight(MediumIndex medium, const Ray& ray, dvec3& throughput,
                                                Random& random) const {
  const auto index = static_cast<size_t>(medium);
  if (!grids_[index]) {
    const auto& homogeneous = std::get<HomogeneousMedium>(scene_.media[index].kind);
    return sample_homogeneous(homogeneous, ray.t_max, throughput, random);
  }
  // Delta tracking (Woodcock et al. 1965) with the majorant of all channels; a collision is real with the
  // probability of the chosen channel, and both outcomes are weighted by the probability mixed over channels.
  const Grids& g = *grids_[index];
  const Interval inside = clip(ray, g.sigma_t.box_low(), g.sigma_t.box_high());
  double t = inside.begin;
  while (g.majorant > 0 && inside.begin < inside.end) {
    t -= std::log1p(-random.uniform()) / g.majorant;
    if (!(t < inside.end)) break;
    const dvec3 p = ray.origin + t * ray.direction;
    const dvec3 sigma_t = g.scale * g.sigma_t.value(p);
    const auto [channel, probability] = choose_channel(throughput, random);
    const double real = glm::dot(probability, sigma_t) / g.majorant;
    if (random.uniform() < sigma_t[channel] / g.majorant) {
      throughput *= g.albedo.value(p) * sigma_t / (real * g.majorant);
      return t;
    }
    throughput *= (g.majorant - sigma_t) / ((1 - real) * g.majorant);
  }
  return std::nullopt;
}

dvec3 Media::transmittance(MediumIndex medium, const Ray& ray, Random& random) const {
  const auto index = static_cast<size_t>(medium);
  const double length = glm::length(ray.direction);
  if (!grids_[index]) {
    return transmittance_homogeneous(std::get<HomogeneousMedium>(scene_.media[index].kind),
                                     ray.t_max * length);
  }
  const Grids& g = *grids_[index];
  const Interval inside = clip(ray, g.sigma_t.box_low(), g.sigma_t.box_high());
  dvec3 result(1);
  double t = inside.begin;
  while (g.majorant > 0 && inside.begin < inside.end && !is_black(result)) {
    t -= std::log1p(-random.uniform()) / (g.majorant * length);
    if (!(t < inside.end)) break;
    result *= 1.0 - g.scale * g.sigma_t.value(ray.origin + t * ray.direction) / g.majorant;
  }
  return result;
}

}  // namespace tachylite::reference
