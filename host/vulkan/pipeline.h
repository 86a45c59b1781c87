#pragma once

#include <compare>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <volk.h>

namespace tachylite::vulkan {

class Device;

/// 32-bit specialization constants by constant_id (bool: 0 or 1; float: its bits).
using SpecializationConstants = std::map<uint32_t, uint32_t>;

class Pipeline {
 public:
  /// The layout need not outlive it.
  Pipeline(const Device& device, VkPipelineLayout layout, const std::string& name, std::span<const uint32_t> spirv,
           const SpecializationConstants& constants);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  VkPipeline handle() const { return handle_; }

 private:
  VkDevice device_;
  VkPipeline handle_ = VK_NULL_HANDLE;
};

/// What equal pipelines have in common.
struct PipelineKey {
  std::vector<uint32_t> spirv;
  SpecializationConstants constants;
  std::vector<uint32_t> bindings;  // BindingTable::signature

  bool operator==(const PipelineKey&) const = default;
};

/// The pipelines that were used last; for several threads.
class KeptPipelines {
 public:
  explicit KeptPipelines(size_t most) : most_(most) {}
  std::shared_ptr<const Pipeline> find(const PipelineKey& key);
  void add(PipelineKey key, std::shared_ptr<const Pipeline> pipeline);
  void clear();

 private:
  size_t most_;
  std::mutex mutex_;
  std::deque<std::pair<PipelineKey, std::shared_ptr<const Pipeline>>> kept_;  // the one used last is in front
};

}  // namespace tachylite::vulkan
