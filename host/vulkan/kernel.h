#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "vulkan/buffer.h"

namespace tachylite::vulkan {

enum class BindingKind { kUniform, kStorage, kTexel };  // kTexel: uniform (read-only) texel buffer
struct Binding {
  uint32_t number = 0;
  BindingKind kind = BindingKind::kStorage;
  const Buffer* buffer = nullptr;         // null: a small buffer of zeros stands in
  VkFormat format = VK_FORMAT_UNDEFINED;  // kTexel only
};

/// The most bytes that a buffer behind such a binding may have on a device.
uint64_t largest_buffer(const DeviceInfo& info, const Binding& binding);

/// One descriptor set (set 0) that all kernels of a renderer share. Buffers must outlive it. Every binding is
/// written: lavapipe crashes on sets with holes. Throws RenderError, with the bytes, for a buffer that is
/// larger than the device's limit for that kind of binding.
class BindingTable {
 public:
  BindingTable(Device& device, std::span<const Binding> bindings, uint32_t push_constant_bytes = 64);
  ~BindingTable();
  BindingTable(const BindingTable&) = delete;
  BindingTable& operator=(const BindingTable&) = delete;

  VkPipelineLayout layout() const { return layout_; }
  VkDescriptorSet set() const { return set_; }
  uint32_t push_constant_bytes() const { return push_constant_bytes_; }

 private:
  void destroy();

  Device& device_;
  Buffer zeros_;
  uint32_t push_constant_bytes_ = 0;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

/// 32-bit specialization constants by constant_id (bool: 0 or 1; float: its bits).
using SpecializationConstants = std::map<uint32_t, uint32_t>;

/// A compute pipeline with entry point main, linked to a binding table.
class Kernel {
 public:
  Kernel(Device& device, const BindingTable& table, std::string name, std::span<const uint32_t> spirv,
         const SpecializationConstants& constants = {});
  ~Kernel();
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  const std::string& name() const { return name_; }
  VkPipeline pipeline() const { return pipeline_; }
  const BindingTable& table() const { return table_; }

 private:
  Device& device_;
  const BindingTable& table_;
  std::string name_;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
};

}  // namespace tachylite::vulkan
