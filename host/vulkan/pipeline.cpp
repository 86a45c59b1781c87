#include "vulkan/pipeline.h"

#include <algorithm>

#include <fmt/format.h>

#include "vulkan/check.h"
#include "vulkan/device.h"

namespace tachylite::vulkan {

Pipeline::Pipeline(const Device& device, VkPipelineLayout layout, const std::string& name,
                   std::span<const uint32_t> spirv, const SpecializationConstants& constants)
    : device_(device.handle()) {
  std::vector<VkSpecializationMapEntry> entries;
  std::vector<uint32_t> values;
  for (const auto& [id, value] : constants) {
    entries.push_back({id, static_cast<uint32_t>(values.size() * sizeof(uint32_t)), sizeof(uint32_t)});
    values.push_back(value);
  }
  VkSpecializationInfo specialization{};
  specialization.mapEntryCount = static_cast<uint32_t>(entries.size());
  specialization.pMapEntries = entries.data();
  specialization.dataSize = values.size() * sizeof(uint32_t);
  specialization.pData = values.data();

  VkShaderModuleCreateInfo module_create{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  module_create.codeSize = spirv.size_bytes();
  module_create.pCode = spirv.data();
  VkShaderModule module = VK_NULL_HANDLE;
  const std::string of_kernel = fmt::format(" (kernel {})", name);
  check(vkCreateShaderModule(device_, &module_create, nullptr, &module), ("vkCreateShaderModule" + of_kernel).c_str());

  VkComputePipelineCreateInfo create{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  create.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  create.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  create.stage.module = module;
  create.stage.pName = "main";
  create.stage.pSpecializationInfo = constants.empty() ? nullptr : &specialization;
  create.layout = layout;
  const VkResult result = vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &create, nullptr, &handle_);
  vkDestroyShaderModule(device_, module, nullptr);
  check(result, ("vkCreateComputePipelines" + of_kernel).c_str());
}

Pipeline::~Pipeline() {
  vkDestroyPipeline(device_, handle_, nullptr);
}

std::shared_ptr<const Pipeline> KeptPipelines::find(const PipelineKey& key) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const auto& kept) { return kept.first == key; });
  if (found == kept_.end()) return nullptr;
  std::rotate(kept_.begin(), found, found + 1);
  return kept_.front().second;
}

void KeptPipelines::add(PipelineKey key, std::shared_ptr<const Pipeline> pipeline) {
  if (most_ == 0) return;
  const std::lock_guard lock(mutex_);
  kept_.emplace_front(std::move(key), std::move(pipeline));
  if (kept_.size() > most_) kept_.pop_back();
}

void KeptPipelines::clear() {
  const std::lock_guard lock(mutex_);
  kept_.clear();
}

}  // namespace tachylite::vulkan
