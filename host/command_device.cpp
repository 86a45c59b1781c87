#include "command_device.h"

#include <cstdlib>

#include <fmt/format.h>

#include "base/error.h"

namespace tachylite {

std::string format_bytes(uint64_t bytes) {
  static const char* const units[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
  double value = static_cast<double>(bytes);
  size_t unit = 0;
  for (; value >= 1024 && unit + 1 < std::size(units); ++unit) value /= 1024;
  return fmt::format("{:.{}f} {}", value, unit == 0 || value >= 100 ? 0 : 1, units[unit]);
}

std::string device_type(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "CPU";
    default:
      return "other";
  }
}

std::string describe(const vulkan::DeviceInfo& device) {
  return fmt::format("{}, {} {}", device.name, device.driver, device.driver_version);
}

vulkan::DeviceOptions device_options(const std::string& selector) {
  const char* const variable = std::getenv("TACHYLITE_VALIDATION");
  vulkan::DeviceOptions options;
  options.selector = selector;
  options.validation = variable && std::string(variable) == "1";
#ifndef NDEBUG
  options.validation = true;
#endif
  return options;
}

void check_validation(const std::vector<std::string>& messages) {
  if (!messages.empty())
    throw RenderError(
        fmt::format("{} validation messages, the first: {}", messages.size(), messages.front()));
}

}  // namespace tachylite
