#pragma once

// Runs the program under test as a user would, and a folder for its files.

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace tachylite::test {

struct ProgramResult {
  int exit_code = -1;  // 128 + the signal where one ended it
  std::string out, err;
};

struct ProgramOptions {
  std::filesystem::path folder;  // working directory; empty: that of the test
  std::vector<std::pair<std::string, std::string>> environment;  // beside that of the test
  uint64_t largest_file = 0;     // bytes; 0: no limit
  double seconds = 120;          // after that it is killed, and the test fails
  /// Called every few milliseconds with what stderr holds so far; returns a signal to send once, or 0.
  std::function<int(const std::string& err)> signal;
};

ProgramResult run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                          const ProgramOptions& options = {});

/// A folder of its own for each test, removed in the end.
class ProgramTest : public ::testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;
  /// A file below the folder, with that text.
  std::filesystem::path write(const std::string& name, const std::string& text) const;
  std::vector<std::string> files() const;  // names of what is in the folder, sorted

  std::filesystem::path folder;
};

}  // namespace tachylite::test
