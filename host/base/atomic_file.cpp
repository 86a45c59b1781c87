#include "base/atomic_file.h"

#include <unistd.h>

#include "base/error.h"

namespace tachylite {

void write_atomically(const std::filesystem::path& target,
                      const std::function<void(const std::filesystem::path&)>& write) {
  // Keep the extension at the end: image writers choose their format by it.
  std::filesystem::path beside = target;
  beside.replace_filename(
      fmt::format(".{}.{}.part{}", target.stem().string(), getpid(), target.extension().string()));
  std::error_code failed;
  try {
    write(beside);
  } catch (...) {
    std::filesystem::remove(beside, failed);
    throw;
  }
  std::filesystem::rename(beside, target, failed);
  if (failed) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw RenderError(fmt::format("cannot write {}: {}", target.string(), failed.message()));
  }
}

}  // namespace tachylite
