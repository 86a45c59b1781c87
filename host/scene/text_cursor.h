#pragma once

#include <charconv>
#include <cmath>
#include <string_view>

#include "base/error.h"

namespace tachylite {

/// Walks over the lines and words of a text file and knows where it is, for messages.
class TextCursor {
 public:
  TextCursor(std::string_view text, FileLocation file) : rest_(text), where_(std::move(file)) {
    where_.line = 1;
  }

  bool at_end() const { return rest_.empty(); }
  const FileLocation& where() const { return where_; }
  std::string_view rest() const { return rest_; }
  [[noreturn]] void fail(const std::string& message) const { throw InputError(where_, message); }

  /// Skips blanks within the line; a backslash at its end continues it on the next one.
  void skip_blanks() {
    while (!rest_.empty()) {
      if (is_blank(rest_[0])) {
        rest_.remove_prefix(1);
      } else if (rest_.starts_with("\\\n") || rest_.starts_with("\\\r\n")) {
        rest_.remove_prefix(rest_[1] == '\n' ? 2 : 3);
        ++where_.line;
      } else {
        return;
      }
    }
  }
  bool at_line_end() {
    skip_blanks();
    return rest_.empty() || rest_[0] == '\n';
  }
  void skip_line() {
    const size_t end = rest_.find('\n');
    if (end == rest_.npos) {
      rest_ = {};
      return;
    }
    rest_.remove_prefix(end + 1);
    ++where_.line;
  }
  /// Blanks and line ends.
  void skip_space() {
    while (at_line_end() && !rest_.empty()) skip_line();
  }
  /// The next word of the line; empty at its end.
  std::string_view word() {
    skip_blanks();
    size_t length = 0;
    while (length < rest_.size() && !is_blank(rest_[length]) && rest_[length] != '\n') ++length;
    const std::string_view found = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return found;
  }
  /// The next word as a number that a float can hold.
  float real(const char* what) {
    skip_blanks();
    const char* const begin = rest_.data();
    const bool plus = rest_.size() > 1 && rest_[0] == '+' && rest_[1] != '-';
    double value = 0;
    const auto [end, error] = std::from_chars(begin + plus, begin + rest_.size(), value);
    const auto length = static_cast<size_t>(end - begin);
    const bool whole = length == rest_.size() || is_blank(rest_[length]) || rest_[length] == '\n';
    const auto narrow = static_cast<float>(value);
    if (error != std::errc() || !whole || !std::isfinite(narrow))
      fail(fmt::format("{} is \"{:.30}\", expected a finite number", what, word()));
    rest_.remove_prefix(length);
    return narrow;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

  std::string_view rest_;
  FileLocation where_;
};

}  // namespace tachylite
