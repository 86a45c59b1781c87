#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tachylite {

/// A number that tells whether two inputs are the same; no protection against who wants to be mistaken.
class Fingerprint {
 public:
  /// What was added before "ab" "c" differs from what was added before "a" "bc".
  void add(std::string_view bytes);
  /// The content of a file. Throws InputError when it cannot be read.
  void add_file(const std::filesystem::path& file);
  std::string text() const;  // 16 hexadecimal digits

 private:
  void mix(uint64_t word);
  uint64_t state_ = 0x9e3779b97f4a7c15u;
};

}  // namespace tachylite
