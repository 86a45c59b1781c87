#pragma once

#include <string>

#include "measure/measurement.h"

namespace tachylite {

/// The report as tables, for a terminal.
std::string describe(const Report& report);

/// "1.23 (1.10 .. 1.37)"
std::string with_interval(const Estimate& e);

}  // namespace tachylite
