#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <volk.h>

#include "vulkan/pipeline.h"

namespace tachylite::vulkan {

/// What `tachylite devices` prints of one Vulkan device, and what a renderer asks before it allocates.
struct DeviceInfo {
  uint32_t index = 0;
  std::string name, driver, driver_version, api_version;
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
  uint32_t subgroup_size = 0;
  bool int64 = false;  // kernels may have integers of 64 bits
  bool slow_texel_fetches = false;  // slower than reads of storage buffers in words of 64 bits
  uint32_t max_workgroup_invocations = 0, max_workgroup_count_x = 0;
  uint64_t max_storage_buffer_range = 0, max_texel_buffer_elements = 0, max_uniform_buffer_range = 0;
  uint32_t max_push_constants = 0;
  uint64_t device_memory = 0;      // of the largest device-local heap [bytes]
  double timestamp_period_ns = 0;  // 0: no timestamps
  std::string unusable;            // why it cannot run us (a missing feature); empty when it can
};

/// All devices of this machine, in Vulkan's order. Throws RenderError when there is no Vulkan loader or
/// driver.
std::vector<DeviceInfo> list_devices();

struct DeviceOptions {
  std::string selector;  // index or a part of the name; empty: discrete GPU, else integrated, else CPU
  bool validation =
      false;  // Khronos validation layer with synchronization checks; its messages are collected
  bool int64 = true;  // false: as on a device whose kernels have no integers of 64 bits
  size_t kept_pipelines = 0;  // so many are kept for later kernels that are equal: where one process renders much
};

/// Instance, device and one compute queue. Everything made from it must be destroyed before it, and is used
/// by one thread at a time.
class Device {
 public:
  /// Throws InputError for a selector that matches no device, RenderError naming the Vulkan call that failed.
  explicit Device(const DeviceOptions& options = {});
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceInfo& info() const { return info_; }
  bool is_cpu() const { return info_.type == VK_PHYSICAL_DEVICE_TYPE_CPU; }
  /// Whether its memory is the host's, which buffers may share (Buffer::over).
  bool imports_host_memory() const { return imports_host_memory_; }
  /// Validation messages (warnings and errors) seen so far on this device.
  std::vector<std::string> validation_messages() const;

  VkDevice handle() const { return device_; }
  VkPhysicalDevice physical() const { return physical_; }
  VkQueue queue() const { return queue_; }
  uint32_t queue_family() const { return queue_family_; }
  /// A memory type that has all of `required` and, if any has them too, `preferred`.
  uint32_t memory_type(uint32_t allowed, VkMemoryPropertyFlags required,
                       VkMemoryPropertyFlags preferred) const;
  KeptPipelines& kept_pipelines() { return kept_pipelines_; }
  uint64_t allocated_bytes() const { return allocated_bytes_; }  // held now through Buffer, but for what is the host's

 private:
  friend class Buffer;
  struct Messages;
  void destroy();

  DeviceInfo info_;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  uint32_t queue_family_ = 0;
  uint64_t allocated_bytes_ = 0;
  bool imports_host_memory_ = false;
  KeptPipelines kept_pipelines_;
  std::unique_ptr<Messages> messages_;
};

}  // namespace tachylite::vulkan
