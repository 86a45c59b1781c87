#include "base/read_file.h"

#include <fstream>

#include "base/error.h"
#include "base/memory.h"

namespace tachylite {

FileLocation locate_file(const std::filesystem::path& file) {
  return {std::make_shared<const std::string>(file.string()), 0};
}

FileBytes read_file(const std::filesystem::path& file, uint64_t max_bytes) {
  const FileLocation where = locate_file(file);
  std::error_code failed;
  if (!std::filesystem::exists(file, failed)) throw InputError(where, "no such file");
  if (!std::filesystem::is_regular_file(file, failed)) throw InputError(where, "not a regular file");
  const uintmax_t size = std::filesystem::file_size(file, failed);
  if (failed) throw InputError(where, "cannot be read: " + failed.message());
  if (size > max_bytes)
    throw InputError(where, fmt::format("the file has {} bytes; at most {} are read", size, max_bytes));
  require_memory(where, "reading the file", size);
  FileBytes bytes{std::make_unique_for_overwrite<char[]>(size), size};
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(bytes.data.get(), static_cast<std::streamsize>(size)))
    throw InputError(where, "cannot be read");
  return bytes;
}

}  // namespace tachylite
