#pragma once

#include "reference/bvh2.h"
#include "reference/random.h"
#include "scene/scene.h"

namespace tachylite::reference {

/// A point of the full film [pixels, x right, y down] drawn for the pixel (x, y) of the crop window in
/// proportion to the reconstruction filter around its centre, inside the crop window: Mitsuba takes no
/// samples outside it, and divides by the sum of filter weights.
dvec2 sample_film_position(const Film& film, int x, int y, Random& random);

/// The camera ray through a point of the full film. Camera space has +x left, +y up, +z forward. The
/// principal point offset (in fractions of the full film) is added to the position. Rays start where z =
/// near_clip and end where z = far_clip. Thin lens: the lens is a disk in the plane z = 0, the plane z =
/// focus_distance is in focus. Orthographic: the film spans [-1, 1] in x, before to_world.
Ray sample_camera_ray(const Sensor& sensor, const dvec2& film_position, Random& random);

}  // namespace tachylite::reference
