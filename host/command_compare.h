#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace tachylite {

struct CompareArguments {
  std::filesystem::path a, b;
  std::optional<std::filesystem::path>
      variance;  // of one sample; then `samples` is the number of them in a pixel of A
  uint64_t samples = 0;
  bool json = false;
};

/// Prints figures and verdict on stdout. Returns the exit code: 1 where a test was made and the images
/// differ, or where values are not finite.
int run_compare(const CompareArguments& arguments);

}  // namespace tachylite
