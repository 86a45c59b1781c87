#pragma once

#include <filesystem>
#include <functional>

namespace tachylite {

/// Writes a file whole or not at all: `write` gets the path of a new file beside `target`, which is then renamed
/// to `target`. On any exception the new file is removed and `target` stays as it was.
/// Throws RenderError when the folder cannot be written; passes on what `write` throws.
void write_atomically(const std::filesystem::path& target,
                      const std::function<void(const std::filesystem::path&)>& write);

/// The new file, while there is one; for signal handlers that remove it before they end the process.
const char* unfinished_file();

}  // namespace tachylite
