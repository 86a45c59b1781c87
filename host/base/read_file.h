#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "base/file_location.h"

namespace tachylite {

/// The bytes of a whole file.
struct FileBytes {
  std::unique_ptr<char[]> data;
  size_t size = 0;
  std::string_view view() const { return {data.get(), size}; }
};

/// A location that means the file as a whole.
FileLocation locate_file(const std::filesystem::path& file);

/// Throws InputError when the file is missing, not a regular file, unreadable or larger than `max_bytes`.
FileBytes read_file(const std::filesystem::path& file, uint64_t max_bytes = uint64_t{1} << 34);

}  // namespace tachylite
