#pragma once

#include <filesystem>

#include "base/file_location.h"

namespace tachylite {

/// To be called before OpenEXR opens a file, as it allocates by what the header says. Makes it refuse what no image
/// has; throws InputError where an attribute does not fit into the file, or its size is not that of its type.
void check_exr_header(const FileLocation& where, const std::filesystem::path& file);

}  // namespace tachylite
