#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vulkan/buffer.h"
#include "vulkan/pipeline.h"

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
  /// What layouts that are identically defined, and so compatible, have in common.
  const std::vector<uint32_t>& signature() const { return signature_; }

 private:
  void destroy();

  Device& device_;
  Buffer zeros_;
  std::vector<uint32_t> signature_;
  uint32_t push_constant_bytes_ = 0;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

/// A compute pipeline with entry point main, linked to a binding table. A device that keeps pipelines (DeviceOptions)
/// compiles it once for all equal kernels: of the same words, constants and kinds of bindings.
class Kernel {
 public:
  Kernel(Device& device, const BindingTable& table, std::string name, std::span<const uint32_t> spirv,
         const SpecializationConstants& constants = {});
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  const std::string& name() const { return name_; }
  VkPipeline pipeline() const { return pipeline_->handle(); }
  const BindingTable& table() const { return table_; }

 private:
  const BindingTable& table_;
  std::string name_;
  std::shared_ptr<const Pipeline> pipeline_;
};

}  // namespace tachylite::vulkan
