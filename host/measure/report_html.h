#pragma once

#include <string>

#include "measure/measurement.h"

namespace tachylite {

/// The report as one page that needs nothing else: plots as SVG, images as PNG in data URIs, style and script inside.
std::string report_html(const Report& report);

}  // namespace tachylite
