#include "vulkan/kernel.h"

#include <algorithm>
#include <array>

#include "base/check.h"
#include "base/error.h"
#include "vulkan/check.h"

namespace tachylite::vulkan {
namespace {

constexpr uint64_t kZeroBytes = 256;

VkDescriptorType descriptor_type(BindingKind kind) {
  switch (kind) {
    case BindingKind::kUniform:
      return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case BindingKind::kStorage:
      return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    case BindingKind::kTexel:
      return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
  }
  return VK_DESCRIPTOR_TYPE_MAX_ENUM;
}

uint64_t texel_bytes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SFLOAT:
      return 4;
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return 8;
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return 16;
    default:
      return 1;  // overestimates the number of elements
  }
}

/// Throws where the device cannot see the whole buffer through such a binding.
void check_range(const Device& device, const Binding& binding, const Buffer& buffer) {
  const uint64_t most = largest_buffer(device.info(), binding);
  if (buffer.size() > most)
    throw RenderError(fmt::format("vkUpdateDescriptorSets: binding {} needs {} bytes, but {} allows {}", binding.number,
                                  buffer.size(), device.info().name, most));
}

}  // namespace

uint64_t largest_buffer(const DeviceInfo& info, const Binding& binding) {
  switch (binding.kind) {
    case BindingKind::kUniform:
      return info.max_uniform_buffer_range;
    case BindingKind::kTexel:
      return info.max_texel_buffer_elements * texel_bytes(binding.format);
    case BindingKind::kStorage:
      return info.max_storage_buffer_range;
  }
  return 0;
}

BindingTable::BindingTable(Device& device, std::span<const Binding> bindings, uint32_t push_constant_bytes)
    : device_(device), zeros_(device, kZeroBytes), push_constant_bytes_(push_constant_bytes) {
  CHECK_LE(push_constant_bytes, device.info().max_push_constants);
  const std::array<char, kZeroBytes> zeros{};
  zeros_.upload(zeros.data(), zeros.size());
  try {
    std::vector<VkDescriptorSetLayoutBinding> layout_bindings;
    std::vector<VkDescriptorPoolSize> sizes;
    for (const Binding& binding : bindings) {
      check_range(device, binding, binding.buffer ? *binding.buffer : zeros_);
      const VkDescriptorType type = descriptor_type(binding.kind);
      signature_.insert(signature_.end(), {binding.number, static_cast<uint32_t>(type)});
      layout_bindings.push_back({binding.number, type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
      sizes.push_back({type, 1});
    }
    VkDescriptorSetLayoutCreateInfo set_create{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set_create.bindingCount = static_cast<uint32_t>(layout_bindings.size());
    set_create.pBindings = layout_bindings.data();
    check(vkCreateDescriptorSetLayout(device.handle(), &set_create, nullptr, &set_layout_),
          "vkCreateDescriptorSetLayout");

    signature_.push_back(push_constant_bytes);
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, push_constant_bytes};
    VkPipelineLayoutCreateInfo layout_create{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layout_create.setLayoutCount = 1;
    layout_create.pSetLayouts = &set_layout_;
    layout_create.pushConstantRangeCount = push_constant_bytes > 0 ? 1 : 0;
    layout_create.pPushConstantRanges = &range;
    check(vkCreatePipelineLayout(device.handle(), &layout_create, nullptr, &layout_),
          "vkCreatePipelineLayout");
    if (bindings.empty()) return;

    VkDescriptorPoolCreateInfo pool_create{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool_create.maxSets = 1;
    pool_create.poolSizeCount = static_cast<uint32_t>(sizes.size());
    pool_create.pPoolSizes = sizes.data();
    check(vkCreateDescriptorPool(device.handle(), &pool_create, nullptr, &pool_), "vkCreateDescriptorPool");
    VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.descriptorPool = pool_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &set_layout_;
    check(vkAllocateDescriptorSets(device.handle(), &allocate, &set_), "vkAllocateDescriptorSets");

    std::vector<VkDescriptorBufferInfo> buffers(bindings.size());
    std::vector<VkBufferView> views(bindings.size());
    std::vector<VkWriteDescriptorSet> writes(bindings.size());
    for (size_t i = 0; i < bindings.size(); ++i) {
      const Buffer& buffer = bindings[i].buffer ? *bindings[i].buffer : zeros_;
      VkWriteDescriptorSet& write = writes[i];
      write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
      write.dstSet = set_;
      write.dstBinding = bindings[i].number;
      write.descriptorCount = 1;
      write.descriptorType = descriptor_type(bindings[i].kind);
      if (bindings[i].kind == BindingKind::kTexel) {
        views[i] = buffer.texel_view(bindings[i].format);
        write.pTexelBufferView = &views[i];
      } else {
        buffers[i] = {buffer.handle(), 0, VK_WHOLE_SIZE};
        write.pBufferInfo = &buffers[i];
      }
    }
    vkUpdateDescriptorSets(device.handle(), static_cast<uint32_t>(writes.size()), writes.data(), 0, nullptr);
  } catch (...) {
    destroy();
    throw;
  }
}

BindingTable::~BindingTable() {
  destroy();
}

void BindingTable::destroy() {
  vkDestroyDescriptorPool(device_.handle(), pool_, nullptr);
  vkDestroyPipelineLayout(device_.handle(), layout_, nullptr);
  vkDestroyDescriptorSetLayout(device_.handle(), set_layout_, nullptr);
}

Kernel::Kernel(Device& device, const BindingTable& table, std::string name, std::span<const uint32_t> spirv,
               const SpecializationConstants& constants)
    : table_(table), name_(std::move(name)) {
  PipelineKey key{{spirv.begin(), spirv.end()}, constants, table.signature()};
  pipeline_ = device.kept_pipelines().find(key);
  if (pipeline_) return;
  pipeline_ = std::make_shared<Pipeline>(device, table.layout(), name_, spirv, constants);
  device.kept_pipelines().add(std::move(key), pipeline_);
}

}  // namespace tachylite::vulkan
