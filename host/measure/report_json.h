#pragma once

#include <filesystem>
#include <string>

#include "measure/measurement.h"

namespace tachylite {

std::string report_json(const Report& report);

/// Reads what report_json wrote (pictures, stages and scaling are left out). Throws InputError when the file is no such
/// report.
Report read_report(const std::filesystem::path& file);

}  // namespace tachylite
