#include "stress/long_run/pipeline_cache.h"

#include <map>
#include <string>

#include <volk.h>

namespace tachylite::test {
namespace {

/// What the driver's functions were, and what was made with them. Handles are told apart by their device.
struct Cache {
  PFN_vkCreateShaderModule create_module = vkCreateShaderModule;
  PFN_vkCreateDescriptorSetLayout create_set_layout = vkCreateDescriptorSetLayout;
  PFN_vkCreatePipelineLayout create_layout = vkCreatePipelineLayout;
  PFN_vkCreateComputePipelines create_pipelines = vkCreateComputePipelines;
  PFN_vkDestroyPipeline destroy_pipeline = vkDestroyPipeline;

  std::map<VkShaderModule, std::string> modules;
  std::map<VkDescriptorSetLayout, std::string> set_layouts;
  std::map<VkPipelineLayout, std::string> layouts;
  std::map<std::pair<VkDevice, std::string>, VkPipeline> pipelines;
};
Cache* cache = nullptr;

template <class T>
void append(std::string& key, const T& value) {
  key.append(reinterpret_cast<const char*>(&value), sizeof value);
}

VkResult create_module(VkDevice device, const VkShaderModuleCreateInfo* create, const VkAllocationCallbacks* allocator,
                       VkShaderModule* module) {
  const VkResult result = cache->create_module(device, create, allocator, module);
  std::string& key = cache->modules[*module];
  key.clear();
  append(key, create->pCode);  // the embedded words never move
  return result;
}

VkResult create_set_layout(VkDevice device, const VkDescriptorSetLayoutCreateInfo* create,
                           const VkAllocationCallbacks* allocator, VkDescriptorSetLayout* layout) {
  const VkResult result = cache->create_set_layout(device, create, allocator, layout);
  std::string& key = cache->set_layouts[*layout];
  key.clear();
  for (uint32_t i = 0; i < create->bindingCount; ++i) {
    append(key, create->pBindings[i].binding);
    append(key, create->pBindings[i].descriptorType);
  }
  return result;
}

VkResult create_layout(VkDevice device, const VkPipelineLayoutCreateInfo* create, const VkAllocationCallbacks* allocator,
                       VkPipelineLayout* layout) {
  const VkResult result = cache->create_layout(device, create, allocator, layout);
  std::string& key = cache->layouts[*layout];
  key.clear();
  for (uint32_t i = 0; i < create->setLayoutCount; ++i) key += cache->set_layouts.at(create->pSetLayouts[i]);
  for (uint32_t i = 0; i < create->pushConstantRangeCount; ++i) append(key, create->pPushConstantRanges[i].size);
  return result;
}

VkResult create_pipelines(VkDevice device, VkPipelineCache driver_cache, uint32_t count,
                          const VkComputePipelineCreateInfo* create, const VkAllocationCallbacks* allocator,
                          VkPipeline* pipelines) {
  for (uint32_t i = 0; i < count; ++i) {
    std::string key = cache->modules.at(create[i].stage.module) + cache->layouts.at(create[i].layout);
    if (const VkSpecializationInfo* constants = create[i].stage.pSpecializationInfo) {
      for (uint32_t k = 0; k < constants->mapEntryCount; ++k) append(key, constants->pMapEntries[k].constantID);
      key.append(static_cast<const char*>(constants->pData), constants->dataSize);
    }
    VkPipeline& kept = cache->pipelines[{device, key}];
    if (kept == VK_NULL_HANDLE) {
      const VkResult result = cache->create_pipelines(device, driver_cache, 1, create + i, allocator, &kept);
      if (result != VK_SUCCESS) return result;
    }
    pipelines[i] = kept;
  }
  return VK_SUCCESS;
}

}  // namespace

void keep_pipelines() {
  static Cache the_cache;
  cache = &the_cache;
  vkCreateShaderModule = create_module;
  vkCreateDescriptorSetLayout = create_set_layout;
  vkCreatePipelineLayout = create_layout;
  vkCreateComputePipelines = create_pipelines;
  vkDestroyPipeline = [](VkDevice, VkPipeline, const VkAllocationCallbacks*) {};
  // Kept pipelines may refer to the layouts that they were made with; those are small.
  vkDestroyPipelineLayout = [](VkDevice, VkPipelineLayout, const VkAllocationCallbacks*) {};
  vkDestroyDescriptorSetLayout = [](VkDevice, VkDescriptorSetLayout, const VkAllocationCallbacks*) {};
}

void forget_pipelines() {
  for (const auto& [key, pipeline] : cache->pipelines) cache->destroy_pipeline(key.first, pipeline, nullptr);
  cache->pipelines.clear();
}

}  // namespace tachylite::test
