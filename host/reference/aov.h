#pragma once

#include <string>
#include <vector>

#include "reference/world.h"
#include "scene/aov.h"

namespace tachylite::reference {

/// Mitsuba's arbitrary output variables (types and names: scene/aov.h) of the first surface that a camera ray hits,
/// null surfaces included, lamps only where hide_emitters does not take them out of the image (Mitsuba's show them
/// anyway, unlike its image). depth is measured along the ray from the near clip plane; sh_normal is without normal and
/// bump maps, as Mitsuba's; prim_index is the triangle's number in its mesh.
class Aovs {
 public:
  /// As parse_aovs. Throws InputError.
  explicit Aovs(const std::vector<std::string>& specifications);

  const std::vector<std::string>& channel_names() const { return names_; }
  /// The channel for the number of samples, which has no value of one sample; empty: none.
  const std::string& sample_count_channel() const { return sample_count_channel_; }
  /// Appends the values of all channels.
  void evaluate(const World& world, const Ray& camera_ray, std::vector<double>& values) const;

 private:
  std::vector<Aov> aovs_;
  std::vector<std::string> names_;
  std::string sample_count_channel_;
};

}  // namespace tachylite::reference
