#pragma once

#include <string>

#include "scene/plugin.h"

namespace tachylite {

/// An opening angle [radians] and the axis it is measured along: x, y, diagonal, smaller or larger.
struct FieldOfView {
  double angle = 0;
  std::string axis = "x";
  /// The full horizontal angle [radians] of a film with that width / height.
  double along_x(double aspect) const;
};

/// Parameters fov and fov_axis, or focal_length ("50mm" by default, of 35 mm film).
FieldOfView read_field_of_view(const Plugin& plugin);

}  // namespace tachylite
