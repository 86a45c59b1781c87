#include "base/scratch_folder.h"

#include <cstdlib>

#include "base/error.h"

namespace tachylite {

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "tachylite-XXXXXX").string();
  if (!mkdtemp(name.data())) throw RenderError("mkdtemp: cannot make " + name);
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace tachylite
