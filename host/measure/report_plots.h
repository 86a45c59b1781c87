#pragma once

#include <string>
#include <vector>

#include "measure/measurement.h"
#include "measure/svg_plot.h"

namespace tachylite {

/// Error against seconds of that clock, of all renderers.
Plot error_plot(const SceneMeasurement& scene, const std::string& clock);

/// One a unit: seconds, memory, error.
std::vector<Plot> scaling_plots(const ScalingSeries& series);

/// All plots of the report side by side in one picture.
std::string report_svg(const Report& report);

}  // namespace tachylite
