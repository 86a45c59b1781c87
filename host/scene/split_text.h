#pragma once

#include <string_view>
#include <vector>

namespace tachylite {

/// Cuts a text into parts of about 128 KiB for parallel reading. Each but the last ends with a line that no backslash
/// continues (TextCursor::skip_blanks). No part is empty.
std::vector<std::string_view> split_text(std::string_view text);

}  // namespace tachylite
