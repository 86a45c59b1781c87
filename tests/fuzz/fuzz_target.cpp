#include "fuzz/fuzz_target.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string_view>

#include "base/error.h"
#include "base/log.h"

namespace tachylite::test {

const std::filesystem::path& fuzz_folder() {
  struct Folder {
    std::filesystem::path path = std::filesystem::temp_directory_path() / fmt::format("tachylite_fuzz_{}", getpid());
    Folder() {
      std::filesystem::create_directories(path);
      set_log_quiet(true);
    }
    ~Folder() {
      std::error_code failed;
      std::filesystem::remove_all(path, failed);
    }
  };
  static const Folder folder;
  return folder.path;
}

void fuzz_file(const char* name, const uint8_t* data, size_t size,
               const std::function<void(const std::filesystem::path&)>& read) {
  const std::filesystem::path file = fuzz_folder() / name;
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    read(file);
  } catch (const InputError& error) {
    const std::string_view message = error.what();
    if (message.starts_with(fuzz_folder().string()) && message.find('\n') == message.npos) return;
    fmt::print(stderr, "not a line that starts with the file: {}\n", message);
    std::abort();
  }
}

}  // namespace tachylite::test
