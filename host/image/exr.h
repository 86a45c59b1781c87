#pragma once

#include <filesystem>

#include "image/image.h"

namespace tachylite {

/// Writes scanline ZIP, float32 and UINT, with the image's channels, words and metadata (string attributes); whole or
/// not at all (base/atomic_file.h). Throws RenderError.
void write_exr(const std::filesystem::path& file, const Image& image);

/// Reads any scanline or tiled EXR of one part as float channels (half and uint widened); a film's sums are words.
/// Throws InputError when the file is missing, broken or larger than `max_pixels`.
Image read_exr(const std::filesystem::path& file, size_t max_pixels = size_t{1} << 28);

}  // namespace tachylite
