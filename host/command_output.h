#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "image/image.h"

namespace tachylite {

using OutputFiles = std::vector<std::filesystem::path>;

/// SCENE.exr in the current folder where none is given. Throws InputError, before anything is computed, when
/// a name ends neither in .exr nor in .png, or a file cannot be made in its folder.
OutputFiles check_outputs(const OutputFiles& given, const std::filesystem::path& scene);

/// Writes the image to every file, by its ending. Throws RenderError.
void write_outputs(const OutputFiles& files, const Image& image);

/// Throws InputError when no file of this name could be made.
void check_writable(const std::filesystem::path& file);

}  // namespace tachylite
