#pragma once

#include <string>
#include <vector>

#include "measure/measurement.h"
#include "vulkan/device.h"

namespace tachylite {

/// "triangles", "lights", "depth", "resolution", "materials".
const std::vector<std::string>& scaling_names();

/// Time and memory as one thing grows, in scenes made for it (scaling_scenes.h); each stage by itself. A series ends
/// after the first point that takes more than `most_seconds`, and says so. cores: all seconds are CPU seconds / cores; 0:
/// wall-clock seconds.
ScalingSeries measure_scaling(const std::string& name, vulkan::Device& device, double most_seconds, int cores);

}  // namespace tachylite
