#pragma once

#include <filesystem>

#include "image/image.h"

namespace tachylite {

/// Writes the channels R G B as 8-bit sRGB PNG of the image clamped to [0, 1]; whole or not at all.
void write_png(const std::filesystem::path& file, const Image& image);

}  // namespace tachylite
