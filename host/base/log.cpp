#include "base/log.h"

#include <atomic>
#include <mutex>

#include <fmt/format.h>

namespace tachylite {
namespace {
std::atomic<bool> quiet_lines{false};
std::mutex stderr_mutex;

void print_line(std::string_view prefix, std::string_view line) {
  if (quiet_lines) return;
  std::lock_guard lock(stderr_mutex);
  fmt::print(stderr, "{}{}\n", prefix, line);
}
}  // namespace

void log_info(std::string_view line) { print_line("", line); }
void log_warning(std::string_view line) { print_line("warning: ", line); }
void set_log_quiet(bool quiet) { quiet_lines = quiet; }
bool log_quiet() { return quiet_lines; }

}  // namespace tachylite
