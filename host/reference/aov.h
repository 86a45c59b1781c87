#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reference/world.h"

namespace tachylite::reference {

/// Mitsuba's arbitrary output variables of the first surface that a camera ray hits, null surfaces included.
///   albedo .R .G .B   depth .T (distance along the ray from the near clip)   position .X .Y .Z   uv .U .V
///   geo_normal, sh_normal (or normal; with normal and bump maps), dp_du, dp_dv .X .Y .Z
///   prim_index .I (triangle of its mesh)   shape_index .I
class Aovs {
 public:
  /// Each of `specifications` is "type" or "name:type", several may be joined by commas. Throws InputError.
  explicit Aovs(const std::vector<std::string>& specifications);

  const std::vector<std::string>& channel_names() const { return names_; }
  /// Appends the values of all channels.
  void evaluate(const World& world, const Ray& camera_ray, std::vector<double>& values) const;

 private:
  std::vector<std::string> types_;
  std::vector<std::string> names_;
};

}  // namespace tachylite::reference
