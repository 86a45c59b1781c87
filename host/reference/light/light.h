#pragma once

// Emitters. wi is the unit direction from the receiver to the light; radiance flows along -wi.
//   sample_light  a direction, with weight = radiance / pdf (for delta lights: the incident irradiance on a
//   surface
//                 facing the light), pdf w.r.t. solid angle at the receiver, both including the choice of the
//                 light
//   pdf_*         the same density for a light that a BSDF or phase sample has hit
// A light is chosen uniformly among those that can be sampled.

#include <memory>
#include <optional>

#include "reference/geometry.h"
#include "reference/light/envmap.h"
#include "scene/scene.h"

namespace tachylite::reference {

struct LightSample {
  dvec3 wi{0};
  dvec3 weight{0};
  double pdf = 0;
  bool delta = false;
  std::optional<dvec3>
      target;  // a point short of the light, on the receiver's side; none: infinitely far away
};

class Lights {
 public:
  explicit Lights(const Geometry& geometry);

  /// Nothing when there is no light, or the one chosen does not shine here. Visibility is the caller's
  /// business.
  std::optional<LightSample> sample_light(const dvec3& receiver, Random& random) const;
  /// Segment to trace for the visibility of a sample, t from 0 to 1 (or to infinity along wi).
  static Ray shadow_ray(const dvec3& origin, const LightSample& sample);

  /// Radiance that the surface emits towards wo (world); 0 without an emitter or from behind.
  dvec3 emitted(const SurfacePoint& surface, const dvec3& wo) const;
  /// Density of sampling the direction of a hit on an emitting surface from `receiver`.
  double pdf_surface(const dvec3& receiver, const SurfacePoint& surface) const;

  /// Radiance from infinitely far away along `direction`, and the density of sampling it.
  dvec3 environment(const dvec3& direction) const;
  double pdf_environment(const dvec3& direction) const;

 private:
  const Geometry& geometry_;
  const Scene& scene_;
  std::vector<int> sampled_;                      // emitters that can be sampled
  std::vector<std::unique_ptr<Envmap>> envmaps_;  // by emitter, else null
};

}  // namespace tachylite::reference
