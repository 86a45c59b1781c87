#pragma once

#include "reference/bsdf/bsdf.h"
#include "reference/geometry.h"
#include "reference/light/light.h"
#include "reference/medium/medium.h"

namespace tachylite::reference {

/// A scene made ready for tracing. Refers to `scene`, which must outlive it and not change.
struct World {
  explicit World(const Scene& s) : scene(s), geometry(s), materials(s), lights(geometry), media(s) {}
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const Scene& scene;
  Geometry geometry;
  Materials materials;
  Lights lights;
  Media media;

  const Shape& shape_of(const SurfacePoint& surface) const {
    return scene.shapes[static_cast<size_t>(surface.shape)];
  }
  /// What the integrators count.
  struct Counters {
    uint64_t closest_rays = 0, shadow_rays = 0;
  };
};

/// Radiance arriving along a camera ray (which may be clipped), for the scene's integrator.
dvec3 trace_path(const World& world, const Ray& camera_ray, Random& random, World::Counters& counters);
dvec3 trace_volpath(const World& world, const Ray& camera_ray, MediumIndex medium, Random& random,
                    World::Counters& counters);

}  // namespace tachylite::reference
