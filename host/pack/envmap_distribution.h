#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "base/bulk_vector.h"

namespace tachylite {

/// A lat-long map with the tables by which light/environment.glsl samples it.
struct EnvironmentTables {
  uint32_t width = 0, height = 0;      // height >= 2: a single row is doubled
  uint32_t levels_x = 0, levels_y = 0;  // of the 4-ary tables of a row's texels, and of the rows
  PageVector<glm::vec4> texels;        // radiance; density of sampling at the texel [1/sr]
  /// `height` records of latitudes (sin^2(theta/2) of the row above, the row, the row below, 0; south of the equator
  /// cos^2(theta/2), and w = 1), then the table of the rows, then those of the texels of each row. A table: levels
  /// from the top down, a row has the cumulative probabilities of its first three children.
  PageVector<glm::vec4> cdf;
  double mean = 0;          // of the radiance's mean component over the sphere
  double sampled_mean = 0;  // of what the density is proportional to; 0: not worth sampling
};

/// radiance: width * height, row 0 at the zenith, finite. With `compensate` the density follows what exceeds the mean
/// (Karlik et al. 2019, "MIS Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling"): valid
/// only where a second technique samples all directions.
EnvironmentTables build_environment(std::span<const glm::vec3> radiance, uint32_t width, uint32_t height,
                                    bool compensate);

}  // namespace tachylite
