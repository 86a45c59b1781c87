#pragma once

// The unit shapes behind rectangle, disk, sphere and cylinder, each in its own space:
//   rectangle  [-1,1]^2 at z = 0, normal +z, uv = ((x+1)/2, (y+1)/2)
//   disk       radius 1 at z = 0, normal +z, uv = (r, phi/2pi)
//   sphere     radius 1, normal outwards, uv = (phi/2pi, theta/pi), theta from +z
//   cylinder   radius 1 from z = 0 to 1, no caps, normal outwards, uv = (phi/2pi, z)
// phi = atan2(y, x), wrapped to [0, 2pi).

#include <optional>

#include "reference/math.h"
#include "scene/scene.h"

namespace tachylite::reference {

/// Map of the unit shape to the space of the scene: center and radius, or p0, p1 and radius, then to_world.
dmat4 unit_shape_to_world(const Shape& shape);

struct AnalyticHit {
  double t;
  dvec3 p;  // on the unit shape: z = 0, or of radius 1 to rounding
};
/// Nearest hit of origin + t direction with 0 < t < t_max, in the space of the unit shape.
std::optional<AnalyticHit> intersect_unit_shape(const Shape& shape, const dvec3& origin,
                                                const dvec3& direction, double t_max);

/// Normal, parameters and derivatives at a point of the unit shape.
struct UnitShapePoint {
  dvec3 normal;
  dvec2 uv;
  dvec3 dp_du, dp_dv;
};
UnitShapePoint unit_shape_point(const Shape& shape, const dvec3& p);

/// Uniform on the unit shape; under a map that keeps the ratios of its areas also on the shape itself.
dvec3 sample_unit_shape(const Shape& shape, const dvec2& u);
/// Area after the map, exact for such maps.
double unit_shape_area(const Shape& shape, const dmat4& to_world);

/// The mesh of the plugin cube: 24 vertices, each face mapped onto [0,1]^2.
std::shared_ptr<const Mesh> make_cube_mesh();

}  // namespace tachylite::reference
