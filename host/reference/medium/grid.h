#pragma once

#include "reference/math.h"
#include "scene/scene.h"

namespace tachylite::reference {

/// Value of a volume at a point of the world: the constant, or the grid over the unit cube of its own space
/// mapped by to_world (with use_grid_bbox the box written in the file comes first). Voxel centres lie at (i +
/// 0.5) / n; trilinear or nearest, clamped (or wrapped) outside. One channel counts for all three.
class GridVolume {
 public:
  explicit GridVolume(const Volume& volume);

  dvec3 value(const dvec3& world) const;
  /// The largest value of any channel.
  double maximum() const { return maximum_; }
  /// Axis-aligned box in the world around the mapped unit cube, also of a constant.
  dvec3 box_low() const { return low_; }
  dvec3 box_high() const { return high_; }

 private:
  dvec3 voxel(int x, int y, int z) const;

  const Volume& volume_;
  dmat4 to_local_{1};
  double maximum_ = 0;
  dvec3 low_{0}, high_{0};
};

}  // namespace tachylite::reference
