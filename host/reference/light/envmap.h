#pragma once

#include <memory>
#include <vector>

#include "reference/random.h"
#include "scene/scene.h"

namespace tachylite::reference {

/// Plugin envmap. For d = inverse(to_world) direction: u = atan2(d.x, -d.z) / 2pi, v = acos(d.y) / pi.
/// Columns have their centres at u = (x + 0.5) / W and repeat; rows lie *on* v = y / (H - 1): row 0 is the
/// zenith (+y), row H-1 the nadir. Bilinear between them. Sampling: a cell between four texels with
/// probability proportional to their mean luminance times the cell's solid angle, uniform in u and cos(theta)
/// within it; so the density is constant on a cell.
class Envmap {
 public:
  explicit Envmap(const EnvironmentEmitter& emitter);

  dvec3 radiance(const dvec3& direction) const;
  dvec3 sample_direction(Random& random) const;
  /// W.r.t. solid angle.
  double pdf_direction(const dvec3& direction) const;

 private:
  dvec3 texel(int x, int y) const;
  /// Column of cells from texel x to x + 1, and row from y to y + 1, and the place within, of a direction.
  struct Place {
    int x, y;
    dvec2 f;
  };
  Place place(const dvec3& direction) const;
  double cell_solid_angle(int y) const;

  const EnvironmentEmitter& emitter_;
  dmat3 to_local_, to_world_;
  int width_, height_;
  std::vector<double> sums_;  // running sum of the weights of the W x (H-1) cells, row by row
};

}  // namespace tachylite::reference
