#pragma once

#include <string_view>

namespace tachylite {

/// Lines for a person, on stderr (stdout carries results only). Safe from several threads.
void log_info(std::string_view line);
void log_warning(std::string_view line);

/// --quiet: info and warnings are dropped.
void set_log_quiet(bool quiet);
bool log_quiet();

}  // namespace tachylite
