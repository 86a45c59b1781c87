#pragma once

#include <filesystem>
#include <memory>

#include "scene/scene.h"

namespace tachylite {

/// Reads a Mitsuba volume file: "VOL", version 3, int32 type (1: float32), nx, ny, nz, channels, float32
/// bounding box (6), then the values, x fastest; little endian. Throws InputError when it is broken, cut
/// short, or holds a value that is not finite or negative, or above 1 where `at_most_one` says so.
std::shared_ptr<const Grid> load_grid(const std::filesystem::path& file, bool at_most_one);

}  // namespace tachylite
