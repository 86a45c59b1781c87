#include "pack/majorant_grid.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "shared/medium.h"

namespace tachylite {
namespace {

int wrap(int64_t index, int n, WrapMode mode) {
  if (mode == WrapMode::kClamp) return static_cast<int>(std::clamp<int64_t>(index, 0, n - 1));
  const int64_t period = mode == WrapMode::kRepeat ? n : 2 * int64_t{n};
  const int64_t inside = ((index % period) + period) % period;
  return static_cast<int>(inside < n ? inside : period - 1 - inside);
}

/// The voxels, wrapped and each once, that lookups between the grid coordinates `low` and `high` of an axis read.
std::vector<int> voxels_between(double low, double high, int n, const Volume& volume) {
  const double margin = 1e-3, half = volume.filter == FilterType::kNearest ? 0 : 0.5;
  const auto limit = [&](double x) { return std::clamp(x, -1e6, 1e6); };  // as the lookup's
  const auto first = static_cast<int64_t>(std::floor(limit(low) - margin - half));
  const auto last = static_cast<int64_t>(std::floor(limit(high) + margin - half)) + (half > 0 ? 1 : 0);
  std::vector<int> voxels;
  for (int64_t i = first; i <= std::min(last, first + 2 * int64_t{n} + 1); ++i) voxels.push_back(wrap(i, n, volume.wrap));
  if (last > first + 2 * int64_t{n} + 1) voxels.push_back(wrap(last, n, volume.wrap));
  std::sort(voxels.begin(), voxels.end());
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  return voxels;
}

double largest_of(const Grid& grid, const std::vector<int> (&voxels)[3]) {
  float largest = 0;
  const auto at = [](int i) { return static_cast<size_t>(i); };
  for (const int z : voxels[2])
    for (const int y : voxels[1])
      for (const int x : voxels[0]) {
        const size_t first = ((at(z) * at(grid.ny) + at(y)) * at(grid.nx) + at(x)) * at(grid.channels);
        for (int c = 0; c < grid.channels; ++c) largest = std::max(largest, grid.values[first + at(c)]);
      }
  return largest;
}

}  // namespace

dmat4 grid_to_world(const Volume& volume) {
  if (!volume.use_grid_bbox) return volume.to_world;
  const dvec3 low = volume.grid->bbox_min, high = volume.grid->bbox_max;
  return volume.to_world * glm::scale(glm::translate(dmat4(1), low), high - low);
}

double largest_value(const Volume& volume) {
  if (!volume.grid) return std::max({volume.constant.x, volume.constant.y, volume.constant.z});
  const auto& values = volume.grid->values;
  return values.empty() ? 0.0 : double{*std::max_element(values.begin(), values.end())};
}

MajorantGrid bound_volume(const Volume& volume, const dvec3& low, const dvec3& high) {
  MajorantGrid result;
  if (!volume.grid) {
    result.values = {largest_value(volume)};
    return result;
  }
  const Grid& grid = *volume.grid;
  const int most = std::max({grid.nx, grid.ny, grid.nz});
  result.cells = glm::ivec3(std::min<int>(gpu::kMajorantCells, most));
  const dvec3 size = (high - low) / dvec3(result.cells);
  const dmat4 to_index = glm::scale(dmat4(1), dvec3(grid.nx, grid.ny, grid.nz)) * glm::inverse(grid_to_world(volume));
  for (int z = 0; z < result.cells.z; ++z)
    for (int y = 0; y < result.cells.y; ++y)
      for (int x = 0; x < result.cells.x; ++x) {
        dvec3 first(1e300), last(-1e300);
        for (int corner = 0; corner < 8; ++corner) {
          const dvec3 p = low + size * dvec3(x + (corner & 1), y + ((corner >> 1) & 1), z + (corner >> 2));
          const dvec3 index = dvec3(to_index * glm::dvec4(p, 1));
          first = glm::min(first, index);
          last = glm::max(last, index);
        }
        const std::vector<int> voxels[3] = {voxels_between(first.x, last.x, grid.nx, volume),
                                            voxels_between(first.y, last.y, grid.ny, volume),
                                            voxels_between(first.z, last.z, grid.nz, volume)};
        result.values.push_back(largest_of(grid, voxels));
      }
  return result;
}

}  // namespace tachylite
