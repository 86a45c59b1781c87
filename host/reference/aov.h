#pragma once

#include <string>
#include <vector>

#include "reference/world.h"
#include "scene/aov.h"

namespace tachylite::reference {

/// Mitsuba's arbitrary output variables (types and names: scene/aov.h) of the first surface that a camera ray hits,
/// null surfaces included. depth is measured along the ray from the near clip plane; sh_normal has normal and bump
/// maps in it; prim_index is the triangle's number in its mesh.
class Aovs {
 public:
  /// As parse_aovs. Throws InputError.
  explicit Aovs(const std::vector<std::string>& specifications);

  const std::vector<std::string>& channel_names() const { return names_; }
  /// Appends the values of all channels.
  void evaluate(const World& world, const Ray& camera_ray, std::vector<double>& values) const;

 private:
  std::vector<Aov> aovs_;
  std::vector<std::string> names_;
};

}  // namespace tachylite::reference
