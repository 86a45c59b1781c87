#pragma once

// What listing and opening devices share; private to host/vulkan.

#include <vector>

#include "vulkan/device.h"

namespace tachylite::vulkan {

/// Loads the Vulkan loader (once a process) and makes an instance of API 1.3. `messenger`, if not null, turns
/// the Khronos validation layer with synchronization validation on; messages of the instance's making go to
/// it, too.
VkInstance create_instance(const VkDebugUtilsMessengerCreateInfoEXT* messenger);

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance);

DeviceInfo describe_device(VkPhysicalDevice physical, uint32_t index);

/// The first queue family that computes, of those with timestamps if there is one; -1 when there is none.
int compute_queue_family(VkPhysicalDevice physical);

}  // namespace tachylite::vulkan
