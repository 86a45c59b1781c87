#pragma once

#include <memory>
#include <string>

namespace tachylite {

/// Where in the input something was said; carried by every scene object so that a late complaint (from packing,
/// say) still names the line. Lines count from 1; line 0 means the file as a whole.
struct FileLocation {
  std::shared_ptr<const std::string> file;
  int line = 0;

  std::string str() const {
    if (!file) return "<input>";
    return line > 0 ? *file + ":" + std::to_string(line) : *file;
  }
};

}  // namespace tachylite
