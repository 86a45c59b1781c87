#pragma once

#include <volk.h>

namespace tachylite::vulkan {

/// Throws RenderError "vkCall failed: VK_ERROR_..." unless result is VK_SUCCESS.
void check(VkResult result, const char* call);
const char* result_name(VkResult result);

}  // namespace tachylite::vulkan
