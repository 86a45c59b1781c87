#include "vulkan/commands.h"

#include "base/check.h"
#include "vulkan/check.h"

namespace tachylite::vulkan {
namespace {

constexpr uint32_t kQueriesPerPool = 512;
constexpr uint32_t kNotTimed = ~0u;

// As check(); but when it throws nothing is in flight, so that what the commands use may be destroyed.
void check_when_idle(const Device& device, VkResult result, const char* call) {
  if (result != VK_SUCCESS) vkQueueWaitIdle(device.queue());
  check(result, call);
}

}  // namespace

Commands::Commands(Device& device) : device_(device) {
  try {
    VkCommandPoolCreateInfo pool_create{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool_create.queueFamilyIndex = device.queue_family();
    check(vkCreateCommandPool(device.handle(), &pool_create, nullptr, &pool_), "vkCreateCommandPool");
    allocate();
    VkFenceCreateInfo fence_create{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vkCreateFence(device.handle(), &fence_create, nullptr, &fence_), "vkCreateFence");
  } catch (...) {
    destroy();
    throw;
  }
}

Commands::~Commands() {
  vkQueueWaitIdle(device_.queue());  // something is in flight only after an exception
  destroy();
}

void Commands::destroy() {
  for (VkQueryPool queries : queries_) vkDestroyQueryPool(device_.handle(), queries, nullptr);
  vkDestroyFence(device_.handle(), fence_, nullptr);
  vkDestroyCommandPool(device_.handle(), pool_, nullptr);
}

void Commands::allocate() {
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = pool_;
  info.commandBufferCount = 1;
  check(vkAllocateCommandBuffers(device_.handle(), &info, &buffer_), "vkAllocateCommandBuffers");
}

void Commands::begin() {
  if (recording_) return;
  if (in_flight_.empty()) check(vkResetCommandPool(device_.handle(), pool_, 0), "vkResetCommandPool");
  VkCommandBufferBeginInfo begin_info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin_info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(buffer_, &begin_info), "vkBeginCommandBuffer");
  recording_ = true;
}

void Commands::barrier() {
  VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  memory.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
  memory.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_UNIFORM_READ_BIT |
                         VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                         VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT;
  vkCmdPipelineBarrier(buffer_, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT |
                           VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_HOST_BIT,
                       0, 1, &memory, 0, nullptr, 0, nullptr);
}

void Commands::write_timestamp(VkPipelineStageFlagBits stage, uint32_t query) {
  if (query == kNotTimed) return;
  vkCmdWriteTimestamp(buffer_, stage, queries_[query / kQueriesPerPool], query % kQueriesPerPool);
}

uint32_t Commands::begin_timing(const Kernel& kernel) {
  if (!timing_ || device_.info().timestamp_period_ns == 0) return kNotTimed;
  const auto query = static_cast<uint32_t>(2 * timed_.size());
  if (query / kQueriesPerPool == queries_.size()) {
    VkQueryPoolCreateInfo create{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    create.queryType = VK_QUERY_TYPE_TIMESTAMP;
    create.queryCount = kQueriesPerPool;
    VkQueryPool queries = VK_NULL_HANDLE;
    check(vkCreateQueryPool(device_.handle(), &create, nullptr, &queries), "vkCreateQueryPool");
    queries_.push_back(queries);
  }
  if (query % kQueriesPerPool == 0)
    vkCmdResetQueryPool(buffer_, queries_[query / kQueriesPerPool], 0, kQueriesPerPool);
  timed_.push_back(kernel.name());
  // The barrier before lets no earlier dispatch run into this one's time.
  write_timestamp(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, query);
  return query + 1;
}

void Commands::bind(const Kernel& kernel, const void* push, uint32_t push_bytes) {
  const BindingTable& table = kernel.table();
  vkCmdBindPipeline(buffer_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
  const VkDescriptorSet set = table.set();
  if (set)
    vkCmdBindDescriptorSets(buffer_, VK_PIPELINE_BIND_POINT_COMPUTE, table.layout(), 0, 1, &set, 0, nullptr);
  if (push) {
    CHECK_LE(push_bytes, table.push_constant_bytes());
    vkCmdPushConstants(buffer_, table.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes, push);
  }
}

void Commands::dispatch(const Kernel& kernel, uint32_t groups_x, const void* push, uint32_t push_bytes) {
  if (groups_x == 0) return;
  CHECK_LE(groups_x, device_.info().max_workgroup_count_x);
  begin();
  bind(kernel, push, push_bytes);
  const uint32_t end = begin_timing(kernel);
  vkCmdDispatch(buffer_, groups_x, 1, 1);
  write_timestamp(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, end);
  barrier();
}

void Commands::dispatch_indirect(const Kernel& kernel, const Buffer& arguments, uint64_t offset,
                                 const void* push, uint32_t push_bytes) {
  begin();
  bind(kernel, push, push_bytes);
  const uint32_t end = begin_timing(kernel);
  vkCmdDispatchIndirect(buffer_, arguments.handle(), offset);
  write_timestamp(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, end);
  barrier();
}

void Commands::fill(const Buffer& buffer, uint32_t value, uint64_t offset, uint64_t bytes) {
  begin();
  vkCmdFillBuffer(buffer_, buffer.handle(), offset, bytes, value);
  barrier();
}

void Commands::copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t from_offset,
                    uint64_t to_offset) {
  if (bytes == 0) return;
  begin();
  const VkBufferCopy region{from_offset, to_offset, bytes};
  vkCmdCopyBuffer(buffer_, from.handle(), to.handle(), 1, &region);
  barrier();
}

void Commands::end_and_submit(VkFence fence) {
  recording_ = false;
  check(vkEndCommandBuffer(buffer_), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &buffer_;
  check_when_idle(device_, vkQueueSubmit(device_.queue(), 1, &submit, fence), "vkQueueSubmit");
}

void Commands::submit() {
  if (!recording_) return;
  end_and_submit(VK_NULL_HANDLE);
  in_flight_.push_back(buffer_);
  allocate();
}

void Commands::submit_and_wait() {
  if (!recording_ && in_flight_.empty()) return;
  begin();
  check(vkResetFences(device_.handle(), 1, &fence_), "vkResetFences");
  end_and_submit(fence_);
  check_when_idle(device_, vkWaitForFences(device_.handle(), 1, &fence_, VK_TRUE, ~0ull), "vkWaitForFences");
  if (!in_flight_.empty())
    vkFreeCommandBuffers(device_.handle(), pool_, static_cast<uint32_t>(in_flight_.size()), in_flight_.data());
  in_flight_.clear();
  collect_times();
}

void Commands::collect_times() {
  std::vector<uint64_t> ticks(2 * timed_.size());
  for (size_t first = 0; first < ticks.size(); first += kQueriesPerPool) {
    const size_t count = std::min<size_t>(kQueriesPerPool, ticks.size() - first);
    check(vkGetQueryPoolResults(device_.handle(), queries_[first / kQueriesPerPool], 0,
                                static_cast<uint32_t>(count), count * sizeof(uint64_t), &ticks[first],
                                sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
  }
  for (size_t i = 0; i < timed_.size(); ++i) {
    KernelTime& time = times_[timed_[i]];
    ++time.dispatches;
    // A counter of fewer than 64 valid bits may wrap; such a pair is worth nothing.
    if (ticks[2 * i + 1] > ticks[2 * i])
      time.seconds +=
          1e-9 * device_.info().timestamp_period_ns * static_cast<double>(ticks[2 * i + 1] - ticks[2 * i]);
  }
  timed_.clear();
}

}  // namespace tachylite::vulkan
