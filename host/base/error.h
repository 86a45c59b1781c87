#pragma once

#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "base/file_location.h"

namespace tachylite {

/// The user's input is at fault (scene, mesh, image, option): one line "file:line: what is wrong, what was
/// expected". main() prints it and exits with 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(one_line(message)) {}
  InputError(const FileLocation& where, const std::string& message) : InputError(where.str() + ": " + message) {}

 private:
  /// What is quoted from a file may hold line ends and escape sequences, and have any length.
  static std::string one_line(std::string message) {
    constexpr size_t kLongest = 8192;
    if (message.size() > kLongest) message.replace(kLongest, message.npos, "...");
    for (char& c : message)
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    return message;
  }
};

/// A render, a Vulkan call or writing a file failed; the message names the call. main() exits with 1.
class RenderError : public std::runtime_error {
 public:
  explicit RenderError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace tachylite
