#include "scene/load_grid.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/read_file.h"

namespace tachylite {

static_assert(std::endian::native == std::endian::little);

std::shared_ptr<const Grid> load_grid(const std::filesystem::path& file, bool at_most_one) {
  const FileLocation where = locate_file(file);
  const FileBytes bytes = read_file(file);
  constexpr size_t kHeaderSize = 48;
  if (bytes.size < kHeaderSize || bytes.view().substr(0, 3) != "VOL")
    throw InputError(where, "not a volume file: it does not start with VOL and a header of 48 bytes");
  if (bytes.data[3] != 3)
    throw InputError(where,
                     fmt::format("volume file of version {}, expected 3", static_cast<int>(bytes.data[3])));

  int32_t header[5];
  float box[6];
  std::memcpy(header, bytes.data.get() + 4, sizeof header);
  std::memcpy(box, bytes.data.get() + 24, sizeof box);
  if (header[0] != 1)
    throw InputError(where, fmt::format("volume file of type {}, expected 1 (float32)", header[0]));
  auto grid = std::make_shared<Grid>();
  grid->path = file.string();
  grid->nx = header[1];
  grid->ny = header[2];
  grid->nz = header[3];
  grid->channels = header[4];
  if (grid->channels != 1 && grid->channels != 3)
    throw InputError(where, fmt::format("volume file with {} channels, expected 1 or 3", grid->channels));
  uint64_t count = static_cast<uint64_t>(grid->channels);
  const uint64_t available = (bytes.size - kHeaderSize) / sizeof(float);
  for (const int n : {grid->nx, grid->ny, grid->nz}) {
    if (n < 1)
      throw InputError(where,
                       fmt::format("volume file of {} x {} x {} voxels", grid->nx, grid->ny, grid->nz));
    count *= static_cast<uint64_t>(n);
    if (count > available)
      throw InputError(
          where, fmt::format("the volume file is cut short: {} x {} x {} voxels of {} channels do not fit "
                             "into its {} bytes",
                             grid->nx, grid->ny, grid->nz, grid->channels, bytes.size));
  }

  grid->values.resize(count);
  std::memcpy(grid->values.data(), bytes.data.get() + kHeaderSize, count * sizeof(float));
  for (size_t i = 0; i < count; ++i) {
    const float value = grid->values[i];
    if (!std::isfinite(value) || value < 0 || (at_most_one && value > 1))
      throw InputError(where,
                       fmt::format("value {} of the volume file is {}, expected {}", i, value,
                                   at_most_one ? "a number within [0, 1]" : "a finite number of at least 0"));
  }
  grid->bbox_min = {box[0], box[1], box[2]};
  grid->bbox_max = {box[3], box[4], box[5]};
  for (int axis = 0; axis < 3; ++axis)
    if (!(grid->bbox_min[axis] < grid->bbox_max[axis]) ||
        !std::isfinite(grid->bbox_max[axis] - grid->bbox_min[axis]))
      throw InputError(where, "the bounding box of the volume file is empty or not finite");
  return grid;
}

}  // namespace tachylite
