#include "command_output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "base/error.h"
#include "image/exr.h"
#include "image/ldr.h"

namespace tachylite {
namespace {

bool is_png(const std::filesystem::path& file) {
  return file.extension() == ".png";
}

}  // namespace

void check_writable(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code failed;
  if (std::filesystem::is_directory(file, failed)) throw InputError(fmt::format("{}: is a folder", name));
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, failed))
    throw InputError(fmt::format("{}: there is no folder {}", name, folder.string()));
  const std::string trial =
      (folder / fmt::format(".{}.{}.trial", file.filename().string(), getpid())).string();
  const int descriptor = open(trial.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
  if (descriptor < 0)
    throw InputError(
        fmt::format("{}: cannot write into {}: {}", name, folder.string(), std::strerror(errno)));
  close(descriptor);
  unlink(trial.c_str());
}

OutputFiles check_outputs(const OutputFiles& given, const std::filesystem::path& scene) {
  OutputFiles files = given;
  if (files.empty()) files.push_back(scene.stem().string() + ".exr");
  for (const std::filesystem::path& file : files) {
    if (!is_png(file) && file.extension() != ".exr")
      throw InputError(fmt::format("-o {}: expected a name that ends in .exr or .png", file.string()));
    check_writable(file);
  }
  return files;
}

void write_outputs(const OutputFiles& files, const Image& image) {
  for (const std::filesystem::path& file : files)
    is_png(file) ? write_png(file, image) : write_exr(file, image);
}

}  // namespace tachylite
