#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace tachylite {

/// The unit cube of a grid's own space, in the world.
dmat4 grid_to_world(const Volume& volume);

/// The largest value of any channel, at any point.
double largest_value(const Volume& volume);

/// Upper bounds of a volume in the cells of a box of the world.
struct MajorantGrid {
  glm::ivec3 cells{1};         // at most kMajorantCells in each axis
  std::vector<double> values;  // x fastest
};

/// Of the box [low, high]. A bound holds for every point of its cell and a thousandth of a voxel beyond, whatever
/// filter, wrap mode and orientation the volume has; it is the largest of the voxels that the cell's box in the grid's
/// own space can reach. A volume without a grid has one cell.
MajorantGrid bound_volume(const Volume& volume, const dvec3& low, const dvec3& high);

}  // namespace tachylite
