#pragma once

#include <cstring>
#include <span>
#include <vector>

#include "vulkan/device.h"

namespace tachylite::vulkan {

/// Who touches the memory: decides the memory type, and whether transfers go through a staging copy.
enum class Domain {
  kDevice,  // kernels only; the host reaches it by upload() and download()
  kHost,    // host-visible and coherent, persistently mapped; kernels may read and write it too
};

/// A buffer with memory of its own; usable as storage, uniform, texel, indirect and transfer buffer, and with
/// texel views of any number of formats. Movable. At least 16 bytes are allocated.
class Buffer {
 public:
  Buffer() = default;
  /// Throws RenderError that says the bytes needed when memory runs out.
  Buffer(Device& device, uint64_t bytes, Domain domain = Domain::kDevice);
  /// Makes a kDevice buffer that holds a copy of `data`.
  template <class T>
  Buffer(Device& device, std::span<const T> data) : Buffer(device, data.size_bytes()) {
    upload(data.data(), data.size_bytes());
  }
  /// A buffer, for kernels to read, that is the host's memory, not a copy of it. `memory` begins a page of 4096 bytes,
  /// ends one after the buffer's end or with it, and must outlive the buffer. Several devices may share it. Only where
  /// device.imports_host_memory().
  static Buffer over(Device& device, const void* memory, uint64_t bytes);
  static constexpr uint64_t kPage = 4096;
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;
  ~Buffer();

  uint64_t size() const { return bytes_; }
  VkBuffer handle() const { return buffer_; }
  explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }

  /// The mapped memory; null for a device-only buffer that is not host-visible.
  void* mapped() const { return mapped_; }
  /// Synchronous copies; they wait for the queue. offset + bytes <= size().
  void upload(const void* source, uint64_t bytes, uint64_t offset = 0);
  void download(void* target, uint64_t bytes, uint64_t offset = 0) const;
  template <class T>
  std::vector<T> download_all() const {
    std::vector<T> values(bytes_ / sizeof(T));
    download(values.data(), values.size() * sizeof(T));
    return values;
  }
  /// Calls write(std::span<T>) with the memory of the whole buffer, which it is to write: the mapped one, or a copy that is
  /// uploaded then. What the span holds before is undefined.
  template <class T, class Write>
  void write_all(const Write& write) {
    std::vector<T> copy(mapped_ ? 0 : bytes_ / sizeof(T));
    write(mapped_ ? mapped_values<T>() : std::span<T>(copy));
    if (!mapped_) upload(copy.data(), copy.size() * sizeof(T));
  }
  /// read(std::span<const T>) of the whole buffer, likewise.
  template <class T, class Read>
  auto read_all(const Read& read) const {
    const std::vector<T> copy = mapped_ ? std::vector<T>() : download_all<T>();
    return read(mapped_ ? std::span<const T>(mapped_values<T>()) : std::span<const T>(copy));
  }
  /// The whole buffer as a texel buffer of that format; made on first use, owned by the buffer. The buffer
  /// must hold at most the device's max_texel_buffer_elements of them (BindingTable checks it).
  VkBufferView texel_view(VkFormat format) const;

 private:
  void create(uint64_t needed, const void* next);
  void destroy();
  template <class T>
  std::span<T> mapped_values() const {
    return {static_cast<T*>(mapped_), bytes_ / sizeof(T)};
  }

  Device* device_ = nullptr;
  uint64_t bytes_ = 0;      // as asked for
  uint64_t allocated_ = 0;  // as allocated
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  void* mapped_ = nullptr;
  mutable std::vector<std::pair<VkFormat, VkBufferView>> views_;
};

}  // namespace tachylite::vulkan
