#pragma once

#include <volk.h>

#include "base/error.h"

namespace tachylite::vulkan {

/// VK_ERROR_DEVICE_LOST: nothing of this device can be used any more, but a new one may work.
class DeviceLost : public RenderError {
 public:
  using RenderError::RenderError;
};

/// Throws RenderError (DeviceLost) "vkCall failed: VK_ERROR_..." unless result is VK_SUCCESS.
void check(VkResult result, const char* call);
const char* result_name(VkResult result);

}  // namespace tachylite::vulkan
