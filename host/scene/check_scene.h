#pragma once

#include "scene/scene.h"

namespace tachylite {

/// Shapes must lie within this distance of the origin along each axis: beyond, squared areas overflow a
/// float.
constexpr double kMaxCoordinate = 1e9;

/// What can be seen of a whole scene only: shapes lie within kMaxCoordinate, and those that emit have an
/// area. Throws InputError with the shape's place.
void check_scene(const Scene& scene);

}  // namespace tachylite
