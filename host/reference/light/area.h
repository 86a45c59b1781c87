#pragma once

#include <optional>

#include "reference/light/light.h"

namespace tachylite::reference {

/// Radiance of an area light towards wo: one-sided, on the side of the *shading* normal, as Mitsuba has it.
dvec3 emitted_area(const AreaEmitter& emitter, const Scene& scene, const SurfacePoint& surface,
                   const dvec3& wo);

/// A point uniform on the shape; nothing where it faces away from the receiver.
std::optional<LightSample> sample_area_light(const AreaEmitter& emitter, int shape, const Geometry& geometry,
                                             const dvec3& receiver, Random& random);
/// Density w.r.t. solid angle at `receiver`: distance^2 / (area cos).
double pdf_area_light(const Geometry& geometry, const dvec3& receiver, const SurfacePoint& surface);

}  // namespace tachylite::reference
