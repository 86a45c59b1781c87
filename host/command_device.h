#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vulkan/device.h"

namespace tachylite {

/// "1.5 GiB", "128 MiB", "12 bytes".
std::string format_bytes(uint64_t bytes);
/// "CPU", "discrete GPU"...
std::string device_type(VkPhysicalDeviceType type);
/// "llvmpipe (LLVM 15.0.6, 256 bits), llvmpipe 22.3.6"
std::string describe(const vulkan::DeviceInfo& device);

/// With validation layers in debug builds, and where the environment has TACHYLITE_VALIDATION=1.
vulkan::DeviceOptions device_options(const std::string& selector);
/// Throws RenderError with the first of a device's validation messages, if there are any.
void check_validation(const std::vector<std::string>& messages);

}  // namespace tachylite
