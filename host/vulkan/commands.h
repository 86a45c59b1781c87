#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "vulkan/kernel.h"

namespace tachylite::vulkan {

struct KernelTime {
  uint64_t dispatches = 0;
  double seconds = 0;  // by timestamp queries, on the device
};

/// Records dispatches and runs them. Every dispatch is followed by a barrier that makes its writes visible to
/// the next dispatch, indirect read, transfer and the host: our kernels form a chain.
class Commands {
 public:
  explicit Commands(Device& device);
  ~Commands();
  Commands(const Commands&) = delete;
  Commands& operator=(const Commands&) = delete;

  /// `push`, if not null, is `push_bytes` of push constants.
  void dispatch(const Kernel& kernel, uint32_t groups_x, const void* push = nullptr, uint32_t push_bytes = 0);
  /// Group counts (x, y, z) are read from `arguments` at byte `offset`.
  void dispatch_indirect(const Kernel& kernel, const Buffer& arguments, uint64_t offset,
                         const void* push = nullptr, uint32_t push_bytes = 0);
  void fill(const Buffer& buffer, uint32_t value, uint64_t offset = 0, uint64_t bytes = VK_WHOLE_SIZE);
  void copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t from_offset = 0,
            uint64_t to_offset = 0);

  /// Runs what was recorded since the last call, while the caller goes on.
  void submit();
  /// Runs what was recorded since the last call and waits for it, and for all before. Throws RenderError
  /// (VK_ERROR_DEVICE_LOST...).
  void submit_and_wait();

  /// Time of each kernel name over all submissions, where timing is on.
  void set_timing(bool on) { timing_ = on; }
  const std::map<std::string, KernelTime>& kernel_times() const { return times_; }

 private:
  void begin();
  void destroy();
  void allocate();
  void end_and_submit(VkFence fence);
  void barrier();
  void write_timestamp(VkPipelineStageFlagBits stage, uint32_t query);
  uint32_t begin_timing(const Kernel& kernel);
  void collect_times();
  void bind(const Kernel& kernel, const void* push, uint32_t push_bytes);

  Device& device_;
  bool timing_ = false;
  bool recording_ = false;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer buffer_ = VK_NULL_HANDLE;
  std::vector<VkCommandBuffer> in_flight_;  // of submit()
  VkFence fence_ = VK_NULL_HANDLE;
  std::vector<VkQueryPool> queries_;  // pools of a fixed size; grows with the dispatches of one submission
  std::vector<std::string> timed_;    // kernel name of each pair of queries in flight
  std::map<std::string, KernelTime> times_;
};

}  // namespace tachylite::vulkan
