#include "base/atomic_file.h"

#include <unistd.h>

#include <cstring>

#include "base/error.h"

namespace tachylite {
namespace {
char unfinished[4096] = "";
}

const char* unfinished_file() { return unfinished; }

void write_atomically(const std::filesystem::path& target,
                      const std::function<void(const std::filesystem::path&)>& write) {
  // Keep the extension at the end: image writers choose their format by it.
  std::filesystem::path beside = target;
  beside.replace_filename(
      fmt::format(".{}.{}.part{}", target.stem().string(), getpid(), target.extension().string()));
  std::error_code failed;
  if (beside.string().size() < sizeof unfinished) std::strcpy(unfinished, beside.c_str());
  try {
    write(beside);
  } catch (...) {
    std::filesystem::remove(beside, failed);
    unfinished[0] = 0;
    throw;
  }
  std::filesystem::rename(beside, target, failed);
  unfinished[0] = 0;
  if (failed) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw RenderError(fmt::format("cannot write {}: {}", target.string(), failed.message()));
  }
}

}  // namespace tachylite
