#include "reference/medium/grid.h"

#include <glm/gtc/matrix_transform.hpp>

namespace tachylite::reference {
namespace {

int wrap(double index, int size, WrapMode mode) {
  const double n = size;
  if (mode == WrapMode::kClamp) return static_cast<int>(std::clamp(index, 0.0, n - 1));
  if (mode == WrapMode::kRepeat) return static_cast<int>(index - n * std::floor(index / n));
  const double j = index - 2 * n * std::floor(index / (2 * n));
  return static_cast<int>(j < n ? j : 2 * n - 1 - j);
}

}  // namespace

GridVolume::GridVolume(const Volume& volume) : volume_(volume) {
  maximum_ = volume.grid ? 0 : max_component(volume.constant);
  dmat4 to_world = volume.to_world;
  if (volume.use_grid_bbox) {
    const dvec3 low = volume.grid->bbox_min, high = volume.grid->bbox_max;
    to_world = to_world * glm::scale(glm::translate(dmat4(1), low), high - low);
  }
  to_local_ = glm::inverse(to_world);
  if (volume.grid)
    for (const float v : volume.grid->values) maximum_ = std::max(maximum_, double{v});
  low_ = dvec3(kInfinity);
  high_ = dvec3(-kInfinity);
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 p = transform_point(to_world, dvec3(corner & 1, (corner >> 1) & 1, corner >> 2));
    low_ = glm::min(low_, p);
    high_ = glm::max(high_, p);
  }
}

dvec3 GridVolume::voxel(int x, int y, int z) const {
  const Grid& grid = *volume_.grid;
  const auto at = [](int i) { return static_cast<size_t>(i); };
  const size_t first = ((at(z) * at(grid.ny) + at(y)) * at(grid.nx) + at(x)) * at(grid.channels);
  if (grid.channels < 3) return dvec3(grid.values[first]);
  return {grid.values[first], grid.values[first + 1], grid.values[first + 2]};
}

dvec3 GridVolume::value(const dvec3& world) const {
  if (!volume_.grid) return volume_.constant;
  const Grid& grid = *volume_.grid;
  const dvec3 p = transform_point(to_local_, world) * dvec3(grid.nx, grid.ny, grid.nz);
  const auto at = [&](const dvec3& index) {
    return voxel(wrap(index.x, grid.nx, volume_.wrap), wrap(index.y, grid.ny, volume_.wrap),
                 wrap(index.z, grid.nz, volume_.wrap));
  };
  if (volume_.filter == FilterType::kNearest) return at(glm::floor(p));
  const dvec3 base = glm::floor(p - 0.5), f = p - 0.5 - base;
  dvec3 sum(0);
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 step(corner & 1, (corner >> 1) & 1, corner >> 2);
    const dvec3 w = glm::mix(1.0 - f, f, step);
    sum += w.x * w.y * w.z * at(base + step);
  }
  return sum;
}

}  // namespace tachylite::reference
