#include "vulkan/buffer.h"

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "base/error.h"
#include "base/memory.h"
#include "vulkan/check.h"

namespace tachylite::vulkan {
namespace {

constexpr uint64_t kSmallestBuffer = 16;
constexpr uint64_t kStagingBytes = 64ull << 20;
constexpr VkMemoryPropertyFlags kMappable =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

[[noreturn]] void out_of_memory(const Device& device, uint64_t bytes, const std::string& why) {
  throw RenderError(
      fmt::format("vkAllocateMemory: a buffer of {} bytes does not fit on {}: {} ({} bytes of {} are in use)",
                  bytes, device.info().name, why, device.allocated_bytes(), device.info().device_memory));
}

/// One copy between two buffers, at once.
void copy_now(const Device& device, VkBuffer from, VkBuffer to, const VkBufferCopy& region) {
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandPoolCreateInfo pool_create{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool_create.queueFamilyIndex = device.queue_family();
  check(vkCreateCommandPool(device.handle(), &pool_create, nullptr, &pool), "vkCreateCommandPool");
  try {
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = pool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check(vkAllocateCommandBuffers(device.handle(), &allocate, &commands), "vkAllocateCommandBuffers");
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    vkCmdCopyBuffer(commands, from, to, 1, &region);
    VkMemoryBarrier to_host{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    to_host.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    to_host.dstAccessMask = VK_ACCESS_HOST_READ_BIT | VK_ACCESS_MEMORY_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &to_host, 0,
                         nullptr, 0, nullptr);
    check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    check(vkQueueSubmit(device.queue(), 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    check(vkQueueWaitIdle(device.queue()), "vkQueueWaitIdle");
  } catch (...) {
    vkDestroyCommandPool(device.handle(), pool, nullptr);
    throw;
  }
  vkDestroyCommandPool(device.handle(), pool, nullptr);
}

}  // namespace

Buffer::Buffer(Device& device, uint64_t bytes, Domain domain) : device_(&device), bytes_(bytes) {
  const uint64_t needed = std::max(bytes, kSmallestBuffer);
  VkPhysicalDeviceVulkan13Properties limits13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES};
  VkPhysicalDeviceVulkan11Properties limits11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES,
                                              &limits13};
  VkPhysicalDeviceProperties2 limits{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &limits11, {}};
  vkGetPhysicalDeviceProperties2(device.physical(), &limits);
  const uint64_t largest = std::min(limits13.maxBufferSize, limits11.maxMemoryAllocationSize);
  if (needed > largest)
    out_of_memory(device, needed, fmt::format("the device allows {} bytes a buffer", largest));

  create(needed, nullptr);
  try {
    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(device.handle(), buffer_, &requirements);
    // Where device memory is the host's own, it is mapped and no copy is ever made.
    const bool unified = device.is_cpu() || device.info().type == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU;
    const uint32_t type =
        domain == Domain::kHost
            ? device.memory_type(requirements.memoryTypeBits, kMappable, VK_MEMORY_PROPERTY_HOST_CACHED_BIT)
            : device.memory_type(requirements.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                                 unified ? kMappable : 0);
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(device.physical(), &memory);
    const uint64_t heap = memory.memoryHeaps[memory.memoryTypes[type].heapIndex].size;
    if (device.allocated_bytes_ + requirements.size > heap)
      out_of_memory(device, needed, fmt::format("its heap has {} bytes", heap));

    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = requirements.size;
    allocate.memoryTypeIndex = type;
    const VkResult result = vkAllocateMemory(device.handle(), &allocate, nullptr, &memory_);
    if (result != VK_SUCCESS) out_of_memory(device, needed, result_name(result));
    allocated_ = requirements.size;
    device.allocated_bytes_ += allocated_;
    check(vkBindBufferMemory(device.handle(), buffer_, memory_, 0), "vkBindBufferMemory");
    if ((memory.memoryTypes[type].propertyFlags & kMappable) == kMappable &&
        (unified || domain == Domain::kHost)) {
      check(vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped_), "vkMapMemory");
      // What the host reads, film above all, it reads more slowly from them.
      if (device.is_cpu() && domain == Domain::kDevice) prefer_huge_pages(mapped_, needed);
    }
  } catch (...) {
    destroy();
    throw;
  }
}

// vkCreateBuffer; next: of its VkBufferCreateInfo.
void Buffer::create(uint64_t needed, const void* next) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, next};
  info.size = needed;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
               VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  const VkResult created = vkCreateBuffer(device_->handle(), &info, nullptr, &buffer_);
  if (created != VK_SUCCESS)
    out_of_memory(*device_, needed, fmt::format("vkCreateBuffer gave {}", result_name(created)));
}

Buffer Buffer::over(Device& device, const void* memory, uint64_t bytes) {
  CHECK(device.imports_host_memory());
  CHECK_EQ(reinterpret_cast<uintptr_t>(memory) % kPage, 0u);
  constexpr VkExternalMemoryHandleTypeFlagBits kHandle = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
  Buffer buffer;
  buffer.device_ = &device;
  buffer.bytes_ = bytes;
  VkExternalMemoryBufferCreateInfo external{VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO};
  external.handleTypes = kHandle;
  buffer.create(bytes, &external);
  VkMemoryRequirements requirements;
  vkGetBufferMemoryRequirements(device.handle(), buffer.buffer_, &requirements);
  // Vulkan imports what may be written; kernels do not.
  VkImportMemoryHostPointerInfoEXT import{VK_STRUCTURE_TYPE_IMPORT_MEMORY_HOST_POINTER_INFO_EXT};
  import.handleType = kHandle;
  import.pHostPointer = const_cast<void*>(memory);
  VkMemoryHostPointerPropertiesEXT pointer{VK_STRUCTURE_TYPE_MEMORY_HOST_POINTER_PROPERTIES_EXT};
  check(vkGetMemoryHostPointerPropertiesEXT(device.handle(), kHandle, import.pHostPointer, &pointer),
        "vkGetMemoryHostPointerPropertiesEXT");
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &import};
  allocate.allocationSize = (bytes + kPage - 1) / kPage * kPage;
  allocate.memoryTypeIndex = device.memory_type(requirements.memoryTypeBits & pointer.memoryTypeBits, 0, 0);
  const VkResult result = vkAllocateMemory(device.handle(), &allocate, nullptr, &buffer.memory_);
  if (result != VK_SUCCESS) out_of_memory(device, bytes, result_name(result));
  check(vkBindBufferMemory(device.handle(), buffer.buffer_, buffer.memory_, 0), "vkBindBufferMemory");
  return buffer;
}

Buffer::Buffer(Buffer&& other) noexcept {
  *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(bytes_, other.bytes_);
  std::swap(allocated_, other.allocated_);
  std::swap(buffer_, other.buffer_);
  std::swap(memory_, other.memory_);
  std::swap(mapped_, other.mapped_);
  std::swap(views_, other.views_);
  return *this;
}

Buffer::~Buffer() {
  destroy();
}

void Buffer::destroy() {
  if (!device_) return;
  for (const auto& [format, view] : views_) vkDestroyBufferView(device_->handle(), view, nullptr);
  vkDestroyBuffer(device_->handle(), buffer_, nullptr);
  vkFreeMemory(device_->handle(), memory_, nullptr);
  device_->allocated_bytes_ -= allocated_;
  device_ = nullptr;
}

void Buffer::upload(const void* source, uint64_t bytes, uint64_t offset) {
  CHECK_LE(offset + bytes, bytes_);
  if (bytes == 0) return;
  if (mapped_) {
    check(vkQueueWaitIdle(device_->queue()), "vkQueueWaitIdle");
    std::memcpy(static_cast<char*>(mapped_) + offset, source, bytes);
    return;
  }
  Buffer staging(*device_, std::min(bytes, kStagingBytes), Domain::kHost);
  for (uint64_t done = 0; done < bytes; done += staging.size()) {
    const uint64_t part = std::min(staging.size(), bytes - done);
    std::memcpy(staging.mapped_, static_cast<const char*>(source) + done, part);
    copy_now(*device_, staging.buffer_, buffer_, {0, offset + done, part});
  }
}

void Buffer::download(void* target, uint64_t bytes, uint64_t offset) const {
  CHECK_LE(offset + bytes, bytes_);
  if (bytes == 0) return;
  if (mapped_) {
    check(vkQueueWaitIdle(device_->queue()), "vkQueueWaitIdle");
    std::memcpy(target, static_cast<const char*>(mapped_) + offset, bytes);
    return;
  }
  Buffer staging(*device_, std::min(bytes, kStagingBytes), Domain::kHost);
  for (uint64_t done = 0; done < bytes; done += staging.size()) {
    const uint64_t part = std::min(staging.size(), bytes - done);
    copy_now(*device_, buffer_, staging.buffer_, {offset + done, 0, part});
    std::memcpy(static_cast<char*>(target) + done, staging.mapped_, part);
  }
}

VkBufferView Buffer::texel_view(VkFormat format) const {
  for (const auto& [known, view] : views_)
    if (known == format) return view;
  VkBufferViewCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  create.buffer = buffer_;
  create.format = format;
  create.range = VK_WHOLE_SIZE;
  VkBufferView view = VK_NULL_HANDLE;
  check(vkCreateBufferView(device_->handle(), &create, nullptr, &view), "vkCreateBufferView");
  views_.emplace_back(format, view);
  return view;
}

}  // namespace tachylite::vulkan
