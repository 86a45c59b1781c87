#pragma once

// Participating media. sigma_t, sigma_s = albedo sigma_t [1/length]; scale multiplies sigma_t. A medium is
// chosen by the boundary crossed last: at a shape that names one, the side that the ray goes to tells
// (interior: opposite to the geometric normal); there is no stack of nested media.
//
// Free flight in coloured media: the channel to sample with is chosen by throughput, and the weight is
// divided by the density mixed over all channels with the same probabilities (Wilkie et al. 2014, "Hero
// Wavelength Spectral Sampling"; Miller et al. 2019, "A null-scattering path integral formulation",
// single-sample balance heuristic).

#include <memory>
#include <optional>
#include <vector>

#include "reference/bvh2.h"
#include "reference/medium/grid.h"
#include "reference/random.h"
#include "scene/scene.h"

namespace tachylite::reference {

class Media {
 public:
  explicit Media(const Scene& scene);

  /// Flies along the ray (unit direction) to a real collision, or to ray.t_max without one. Multiplies
  /// `throughput` by sigma_s T / density at a collision, by T / probability at the end.
  std::optional<double> sample_free_flight(MediumIndex medium, const Ray& ray, dvec3& throughput,
                                           Random& random) const;

  /// An unbiased estimate of the transmittance from t = 0 to ray.t_max: exact in homogeneous media, by ratio
  /// tracking (Novak et al. 2014) in others. The direction may be of any length.
  dvec3 transmittance(MediumIndex medium, const Ray& ray, Random& random) const;

  const PhaseFunction& phase(MediumIndex medium) const {
    return scene_.media[static_cast<size_t>(medium)].phase;
  }

 private:
  struct Grids {
    GridVolume sigma_t, albedo;
    double scale;
    double majorant;  // of scale * sigma_t, all channels
  };
  const Scene& scene_;
  std::vector<std::unique_ptr<Grids>> grids_;  // by medium; null: homogeneous
};

}  // namespace tachylite::reference
