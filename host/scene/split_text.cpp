#include "scene/split_text.h"

namespace tachylite {

std::vector<std::string_view> split_text(std::string_view text) {
  constexpr size_t kPartBytes = size_t{1} << 17;
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    size_t end = kPartBytes < text.size() ? text.find('\n', kPartBytes) : text.npos;
    while (end != text.npos) {
      const std::string_view line = text.substr(0, end);
      if (!line.ends_with('\\') && !line.ends_with("\\\r")) break;
      end = text.find('\n', end + 1);
    }
    parts.push_back(text.substr(0, end == text.npos ? text.npos : end + 1));
    text.remove_prefix(parts.back().size());
  }
  return parts;
}

}  // namespace tachylite
