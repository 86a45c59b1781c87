#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/error.h"

namespace tachylite {

/// Walks over the lines and words of a text file and knows where it is, for messages.
class TextCursor {
 public:
  /// `where` the text begins: in its line, or without one in the first.
  TextCursor(std::string_view text, FileLocation where)
      : at_(text.data()), end_(text.data() + text.size()), where_(std::move(where)) {
    where_.line = std::max(where_.line, 1);
  }

  bool at_end() const { return at_ == end_; }
  const FileLocation& where() const { return where_; }
  std::string_view rest() const { return {at_, static_cast<size_t>(end_ - at_)}; }
  [[noreturn]] void fail(const std::string& message) const { throw InputError(where_, message); }

  /// Skips blanks within the line; a backslash at its end continues it on the next one.
  void skip_blanks() {
    do
      while (at_ != end_ && is_blank(*at_)) ++at_;
    while (at_ != end_ && *at_ == '\\' && continue_line());
  }
  bool at_line_end() {
    skip_blanks();
    return at_ == end_ || *at_ == '\n';
  }
  void skip_line() {
    const size_t end = rest().find('\n');
    if (end == std::string_view::npos) {
      at_ = end_;
      return;
    }
    at_ += end + 1;
    ++where_.line;
  }
  /// Blanks and line ends.
  void skip_space() {
    while (at_line_end() && !at_end()) {
      ++at_;
      ++where_.line;
    }
  }
  /// The next word of the line; empty at its end.
  std::string_view word() {
    skip_blanks();
    const char* const begin = at_;
    while (at_ != end_ && !is_blank(*at_) && *at_ != '\n') ++at_;
    return {begin, static_cast<size_t>(at_ - begin)};
  }
  /// The next word as a number that a float can hold.
  float real(const char* what) {
    skip_blanks();
    const bool plus = end_ - at_ > 1 && at_[0] == '+' && at_[1] != '-';
    double value = 0;
    const auto [end, error] = std::from_chars(at_ + plus, end_, value);
    const bool whole = end == end_ || is_blank(*end) || *end == '\n';
    const auto narrow = static_cast<float>(value);
    if (error != std::errc() || !whole || !std::isfinite(narrow)) [[unlikely]] fail_number(what);
    at_ = end;
    return narrow;
  }
  /// The next word as a whole number.
  int64_t integer() {
    skip_blanks();
    int64_t value = 0;
    const auto [end, error] = std::from_chars(at_, end_, value);
    const bool whole = end == end_ || is_blank(*end) || *end == '\n';
    if (error != std::errc() || !whole) [[unlikely]] fail_integer();
    at_ = end;
    return value;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
  // Apart, so that the numbers' functions are small.
  [[noreturn, gnu::noinline]] void fail_number(const char* what) {
    fail(fmt::format("{} is \"{:.30}\", expected a finite number", what, word()));
  }
  [[noreturn, gnu::noinline]] void fail_integer() {
    fail(fmt::format("\"{:.30}\" stands where a whole number is expected", word()));
  }
  [[gnu::noinline]] bool continue_line() {
    const size_t bytes = rest().starts_with("\\\n") ? 2 : rest().starts_with("\\\r\n") ? 3 : 0;
    at_ += bytes;
    where_.line += bytes > 0;
    return bytes > 0;
  }

  const char *at_, *end_;
  FileLocation where_;
};

}  // namespace tachylite
