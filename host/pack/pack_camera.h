#pragma once

#include "scene/scene.h"
#include "shared/render_params.h"

namespace tachylite {

/// Fills the camera, film and filter members of `params` from a sensor; device space = world space - centre.
void pack_camera(const Sensor& sensor, const glm::dvec3& centre, gpu::RenderParams& params);

}  // namespace tachylite
