#include "vulkan/check.h"

#include "base/error.h"

namespace tachylite::vulkan {

const char* result_name(VkResult result) {
#define NAME(code) \
  case code:       \
    return #code;
  switch (result) {
    NAME(VK_SUCCESS)
    NAME(VK_NOT_READY)
    NAME(VK_TIMEOUT)
    NAME(VK_EVENT_SET)
    NAME(VK_EVENT_RESET)
    NAME(VK_INCOMPLETE)
    NAME(VK_ERROR_OUT_OF_HOST_MEMORY)
    NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY)
    NAME(VK_ERROR_INITIALIZATION_FAILED)
    NAME(VK_ERROR_DEVICE_LOST)
    NAME(VK_ERROR_MEMORY_MAP_FAILED)
    NAME(VK_ERROR_LAYER_NOT_PRESENT)
    NAME(VK_ERROR_EXTENSION_NOT_PRESENT)
    NAME(VK_ERROR_FEATURE_NOT_PRESENT)
    NAME(VK_ERROR_INCOMPATIBLE_DRIVER)
    NAME(VK_ERROR_TOO_MANY_OBJECTS)
    NAME(VK_ERROR_FORMAT_NOT_SUPPORTED)
    NAME(VK_ERROR_FRAGMENTED_POOL)
    NAME(VK_ERROR_OUT_OF_POOL_MEMORY)
    NAME(VK_ERROR_INVALID_EXTERNAL_HANDLE)
    NAME(VK_ERROR_FRAGMENTATION)
    NAME(VK_ERROR_VALIDATION_FAILED_EXT)
    NAME(VK_ERROR_INVALID_SHADER_NV)
    default:
      return "VK_ERROR_UNKNOWN";
  }
#undef NAME
}

void check(VkResult result, const char* call) {
  if (result == VK_SUCCESS) return;
  const std::string message = fmt::format("{} failed: {} ({})", call, result_name(result), static_cast<int>(result));
  if (result == VK_ERROR_DEVICE_LOST) throw DeviceLost(message);
  throw RenderError(message);
}

}  // namespace tachylite::vulkan
