#pragma once

// Runs a small kernel over arrays. A test kernel is a .comp beside the test, found by its file name:
//
//   layout(local_size_x = 64) in;                     // kTestGroupSize
//   layout(push_constant) uniform Push { uint count; };
//   layout(set = 0, binding = 0) readonly buffer In { float x[]; };
//   layout(set = 0, binding = 1) writeonly buffer Out { float y[]; };
//   void main() { uint i = gl_GlobalInvocationID.x; if (i < count) y[i] = f(x[i]); }
//
//   TEST_F(DeviceTest, F) { auto y = map_kernel<float>("f", std::span<const float>(x)); ... }

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "vulkan/commands.h"

namespace tachylite::test {

inline constexpr uint32_t kTestGroupSize = 64;

/// The process's one device, with validation on. The driver is that of the environment.
vulkan::Device& device();

/// Base of every test that uses device(): fails a test in which a validation message appears.
class DeviceTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

 private:
  size_t messages_before_ = 0;
};

/// One kernel with its buffers. Bindings are set 0; unset ones do not exist.
class KernelRun {
 public:
  /// A kernel of tests/*/NAME.comp.
  explicit KernelRun(const std::string& name);
  KernelRun(std::string name, std::span<const uint32_t> spirv);

  template <class T>
  KernelRun& storage(uint32_t binding, std::span<const T> data) {
    return add(binding, vulkan::BindingKind::kStorage, VK_FORMAT_UNDEFINED, data.data(), data.size_bytes());
  }
  template <class T>
  KernelRun& uniform(uint32_t binding, const T& data) {
    return add(binding, vulkan::BindingKind::kUniform, VK_FORMAT_UNDEFINED, &data, sizeof(T));
  }
  template <class T>
  KernelRun& texels(uint32_t binding, VkFormat format, std::span<const T> data) {
    return add(binding, vulkan::BindingKind::kTexel, format, data.data(), data.size_bytes());
  }
  /// A storage buffer of zeros, to be read with result().
  template <class T>
  KernelRun& output(uint32_t binding, size_t count) {
    const std::vector<char> zeros(count * sizeof(T));
    return storage(binding, std::span<const char>(zeros));
  }
  KernelRun& constant(uint32_t id, uint32_t value) {
    constants_[id] = value;
    return *this;
  }
  /// Push constants; without a call they are the number of invocations, a uint.
  template <class T>
  KernelRun& push(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    push_.assign(reinterpret_cast<const char*>(&value), reinterpret_cast<const char*>(&value) + sizeof(T));
    return *this;
  }

  /// ceil(invocations / kTestGroupSize) workgroups; waits. May be called again, with other push constants.
  KernelRun& run(size_t invocations);

  template <class T>
  std::vector<T> result(uint32_t binding) const {
    return buffers_.at(binding).buffer.template download_all<T>();
  }
  /// Device seconds of all runs so far, by timestamps.
  double seconds() const { return seconds_; }

 private:
  struct Slot {
    vulkan::BindingKind kind;
    VkFormat format;
    vulkan::Buffer buffer;
  };
  KernelRun& add(uint32_t binding, vulkan::BindingKind kind, VkFormat format, const void* data, size_t bytes);

  std::string name_;
  std::span<const uint32_t> spirv_;
  std::map<uint32_t, Slot> buffers_;
  vulkan::SpecializationConstants constants_;
  std::vector<char> push_;
  std::unique_ptr<vulkan::BindingTable> table_;
  std::unique_ptr<vulkan::Kernel> kernel_;
  double seconds_ = 0;
};

/// Binding 0 = input, binding 1 = one Out per input element, push constant = their number.
template <class Out, class In>
std::vector<Out> map_kernel(const std::string& name, std::span<const In> input,
                            const vulkan::SpecializationConstants& constants = {}) {
  KernelRun run(name);
  run.storage(0, input).template output<Out>(1, input.size());
  for (const auto& [id, value] : constants) run.constant(id, value);
  return run.run(input.size()).template result<Out>(1);
}

}  // namespace tachylite::test
