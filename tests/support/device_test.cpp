#include "support/device_test.h"

#include "test_kernel_spirv.h"

#ifdef __SANITIZE_ADDRESS__
// Drivers leak, and are unloaded before their leaks could be told from ours.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "detect_leaks=0";
}
#endif

namespace tachylite::test {
namespace {

constexpr uint32_t kPushBytes = 128;
// Most of the time of tests would go to compiling the same kernels again.
constexpr size_t kKeptPipelines = 48;

}  // namespace

vulkan::Device& device() {
  static vulkan::Device the_device({.validation = true, .kept_pipelines = kKeptPipelines});
  return the_device;
}

void DeviceTest::SetUp() {
  messages_before_ = device().validation_messages().size();
}

void DeviceTest::TearDown() {
  const std::vector<std::string> messages = device().validation_messages();
  for (size_t i = messages_before_; i < messages.size(); ++i) ADD_FAILURE() << "validation: " << messages[i];
}

KernelRun::KernelRun(const std::string& name) : KernelRun(name, test_kernel_spirv(name)) {}

KernelRun::KernelRun(std::string name, std::span<const uint32_t> spirv)
    : name_(std::move(name)), spirv_(spirv) {}

KernelRun& KernelRun::add(uint32_t binding, vulkan::BindingKind kind, VkFormat format, const void* data,
                          size_t bytes) {
  kernel_.reset();
  table_.reset();
  Slot slot{kind, format, vulkan::Buffer(device(), bytes)};
  slot.buffer.upload(data, bytes);
  buffers_.insert_or_assign(binding, std::move(slot));
  return *this;
}

KernelRun& KernelRun::run(size_t invocations) {
  if (!kernel_) {
    std::vector<vulkan::Binding> bindings;
    for (const auto& [number, slot] : buffers_)
      bindings.push_back({number, slot.kind, &slot.buffer, slot.format});
    table_ = std::make_unique<vulkan::BindingTable>(device(), bindings, kPushBytes);
    kernel_ = std::make_unique<vulkan::Kernel>(device(), *table_, name_, spirv_, constants_);
  }
  const auto count = static_cast<uint32_t>(invocations);
  vulkan::Commands commands(device());
  commands.set_timing(true);
  const uint32_t groups = (count + kTestGroupSize - 1) / kTestGroupSize;
  if (push_.empty())
    commands.dispatch(*kernel_, groups, &count, sizeof(count));
  else
    commands.dispatch(*kernel_, groups, push_.data(), static_cast<uint32_t>(push_.size()));
  commands.submit_and_wait();
  for (const auto& [name, time] : commands.kernel_times()) seconds_ += time.seconds;
  return *this;
}

}  // namespace tachylite::test
