// The Vulkan layer itself: bindings, constants, barriers, indirect dispatch, timestamps, errors.

#include <algorithm>
#include <cstring>
#include <numeric>

#include "base/bulk_vector.h"
#include "base/error.h"
#include "support/device_test.h"
#include "test_kernel_spirv.h"
#include "vulkan/buffer.h"
#include "vulkan/check.h"

namespace tachylite::vulkan {
namespace {

using test::device;
class Vulkan : public test::DeviceTest {};

struct Push {
  uint32_t count = 1000, offset = 5;
};

/// The kernel of vulkan_add.comp over 1000 items with all kinds of bindings.
class AddTest : public Vulkan {
 protected:
  static constexpr uint32_t kCount = 1000, kScale = 7, kUniform = 11;
  static std::vector<uint32_t> ramp(uint32_t step) {
    std::vector<uint32_t> values(kCount);
    for (uint32_t i = 0; i < kCount; ++i) values[i] = i * step;
    return values;
  }
  static uint32_t term(uint32_t i) { return i + 3 * i + kScale + Push().offset + kUniform; }

  const std::vector<uint32_t> ramp1_ = ramp(1), ramp3_ = ramp(3);
  const uint32_t uniform_[4] = {kUniform, 0, 0, 0};
  Buffer a_{device(), std::span<const uint32_t>(ramp1_)}, b_{device(), std::span<const uint32_t>(ramp3_)};
  Buffer sum_{device(), kCount * sizeof(uint32_t)};
  Buffer uniform_buffer_{device(), std::span<const uint32_t>(uniform_)};
  std::vector<Binding> bindings_{{0, BindingKind::kStorage, &a_},
                                 {1, BindingKind::kTexel, &b_, VK_FORMAT_R32_UINT},
                                 {2, BindingKind::kStorage, &sum_},
                                 {3, BindingKind::kUniform, &uniform_buffer_}};
  BindingTable table_{device(), bindings_};
  Kernel add_{device(), table_, "add", test_kernel_spirv("vulkan_add"), {{0, kScale}, {1, 32}}};
  const uint32_t groups_ = (kCount + 31) / 32;
};

TEST_F(AddTest, ChainsOfDispatchesSeeEachOther) {
  constexpr uint32_t kDispatches = 700;  // more than one pool of timestamps
  Commands commands(device());
  commands.set_timing(true);
  for (int submission = 0; submission < 2; ++submission) {
    commands.fill(sum_, 0);
    const Push push;
    for (uint32_t i = 0; i < kDispatches; ++i) commands.dispatch(add_, groups_, &push, sizeof(push));
    commands.submit_and_wait();
    const auto sum = sum_.download_all<uint32_t>();
    for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(sum[i], kDispatches * term(i)) << i;
  }
  const KernelTime time = commands.kernel_times().at("add");
  EXPECT_EQ(time.dispatches, 2 * kDispatches);
  EXPECT_GT(time.seconds, 0);
  EXPECT_LT(time.seconds, 60);
}

// The device of tests keeps pipelines.
TEST_F(AddTest, EqualKernelsShareAPipeline) {
  Buffer other_sum(device(), kCount * sizeof(uint32_t));
  std::vector<Binding> bindings = bindings_;
  bindings[2].buffer = &other_sum;
  const BindingTable table(device(), bindings);
  const auto spirv = test_kernel_spirv("vulkan_add");
  const Kernel same(device(), table, "same", spirv, {{0, kScale}, {1, 32}});
  const Kernel next(device(), table, "next", spirv, {{0, kScale + 1}, {1, 32}});
  EXPECT_EQ(same.pipeline(), add_.pipeline());
  EXPECT_NE(next.pipeline(), add_.pipeline());
  bindings.push_back({4, BindingKind::kStorage, nullptr});
  const BindingTable longer(device(), bindings);
  EXPECT_NE(Kernel(device(), longer, "longer", spirv, {{0, kScale}, {1, 32}}).pipeline(), add_.pipeline());

  Commands commands(device());
  commands.fill(sum_, 0);
  commands.fill(other_sum, 0);
  const Push push;
  commands.dispatch(add_, groups_, &push, sizeof(push));
  for (const Kernel* kernel : {&same, &next}) commands.dispatch(*kernel, groups_, &push, sizeof(push));
  commands.submit_and_wait();
  const auto sum = sum_.download_all<uint32_t>(), other = other_sum.download_all<uint32_t>();
  for (uint32_t i = 0; i < kCount; ++i) {
    ASSERT_EQ(sum[i], term(i)) << i;
    ASSERT_EQ(other[i], 2 * term(i) + 1) << i;
  }
}

TEST_F(AddTest, IndirectDispatchReadsWhatWasCopied) {
  const uint32_t arguments[] = {0, 0, 0, groups_, 1, 1};
  Buffer source(device(), std::span<const uint32_t>(arguments));
  Buffer target(device(), sizeof(arguments));
  Commands commands(device());
  commands.fill(sum_, 0);
  commands.copy(source, target, sizeof(arguments));
  const Push push;
  commands.dispatch_indirect(add_, target, 0, &push, sizeof(push));  // 0 groups: nothing
  commands.dispatch_indirect(add_, target, 12, &push, sizeof(push));
  commands.submit_and_wait();
  const auto sum = sum_.download_all<uint32_t>();
  for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(sum[i], term(i)) << i;
}

TEST_F(AddTest, UnboundBuffersAreZeros) {
  for (Binding& binding : bindings_)
    if (binding.number != 2) binding.buffer = nullptr;
  BindingTable table(device(), bindings_);
  Kernel add(device(), table, "add", test_kernel_spirv("vulkan_add"), {{1, 64}});
  Commands commands(device());
  commands.fill(sum_, 1);
  const Push push{64, 0};
  commands.dispatch(add, 1, &push, sizeof(push));
  commands.submit_and_wait();
  const auto sum = sum_.download_all<uint32_t>();
  for (uint32_t i = 0; i < 64; ++i) ASSERT_EQ(sum[i], 1u) << i;
}

TEST_F(Vulkan, BuffersKeepBytesAndCountThem) {
  const uint64_t before = device().allocated_bytes();
  {
    std::vector<unsigned char> bytes(100001);
    std::iota(bytes.begin(), bytes.end(), static_cast<unsigned char>(0));
    for (Domain domain : {Domain::kDevice, Domain::kHost}) {
      Buffer buffer(device(), bytes.size(), domain);
      buffer.upload(bytes.data(), bytes.size());
      buffer.upload(bytes.data(), 10, 99000);
      Buffer moved = std::move(buffer);
      EXPECT_FALSE(buffer);
      auto got = moved.download_all<unsigned char>();
      EXPECT_TRUE(std::equal(bytes.begin(), bytes.begin() + 99000, got.begin()));
      EXPECT_EQ(std::memcmp(&got[99000], bytes.data(), 10), 0);
      EXPECT_GE(device().allocated_bytes(), before + bytes.size());
    }
    Buffer empty(device(), 0);
    EXPECT_TRUE(empty.download_all<float>().empty());
  }
  EXPECT_EQ(device().allocated_bytes(), before);
}

// Of two devices over the same memory, which both see what the host writes there.
TEST_F(Vulkan, BuffersOverTheHostsMemory) {
  if (!device().imports_host_memory()) GTEST_SKIP() << "this device does not";
  BulkVector<uint32_t> values((1 << 20) + 3);
  ASSERT_TRUE(owns_pages(values));
  std::iota(values.begin(), values.end(), 7u);
  vulkan::Device other({.validation = true});
  const uint64_t before = device().allocated_bytes();
  for (vulkan::Device* on : {&device(), &other}) {
    Buffer buffer = Buffer::over(*on, values.data(), values.size() * sizeof(uint32_t));
    EXPECT_EQ(buffer.size(), values.size() * sizeof(uint32_t));
    EXPECT_EQ(device().allocated_bytes(), before);
    EXPECT_TRUE(std::ranges::equal(buffer.download_all<uint32_t>(), values));
    values[5] += 100;
    values.back() = 1;
    const Buffer moved = std::move(buffer);
    EXPECT_TRUE(std::ranges::equal(moved.download_all<uint32_t>(), values));
  }
  for (const std::string& message : other.validation_messages()) ADD_FAILURE() << message;
}

template <class Error, class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "(nothing was thrown)";
}

TEST_F(Vulkan, TooLargeABufferSaysTheBytes) {
  const uint64_t bytes = 1ull << 50;
  const std::string message = message_of<RenderError>([&] { Buffer(device(), bytes); });
  EXPECT_NE(message.find(std::to_string(bytes)), std::string::npos) << message;
  EXPECT_NE(message.find("vkAllocateMemory"), std::string::npos) << message;
}

TEST_F(Vulkan, TooLargeABindingSaysTheBytes) {
  const uint64_t bytes = device().info().max_uniform_buffer_range + 16;
  Buffer buffer(device(), bytes);
  const Binding binding{0, BindingKind::kUniform, &buffer};
  const std::string message =
      message_of<RenderError>([&] { BindingTable(device(), std::span<const Binding>(&binding, 1)); });
  EXPECT_NE(message.find(std::to_string(bytes)), std::string::npos) << message;
}

TEST_F(Vulkan, SelectorsChooseDevices) {
  const auto infos = list_devices();
  ASSERT_FALSE(infos.empty());
  const std::string name = infos[0].name.substr(0, 8);
  EXPECT_EQ(Device({.selector = "0"}).info().name, infos[0].name);
  EXPECT_EQ(Device({.selector = name}).info().name.substr(0, 8), name);
  const std::string message = message_of<InputError>([] { Device({.selector = "no such device"}); });
  EXPECT_NE(message.find(infos[0].name), std::string::npos) << message;
  EXPECT_THROW(Device({.selector = "99"}), InputError);
}

TEST_F(Vulkan, ErrorsNameTheCall) {
  EXPECT_EQ(message_of<RenderError>([] { check(VK_ERROR_DEVICE_LOST, "vkQueueSubmit"); }),
            "vkQueueSubmit failed: VK_ERROR_DEVICE_LOST (-4)");
}

}  // namespace

// The layer is really there: a wrong call must leave a message.
TEST(VulkanValidation, SeesAWrongCall) {
  Device checked({.validation = true});
  VkBufferCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  create.size = 0;  // not allowed
  create.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  VkBuffer buffer = VK_NULL_HANDLE;
  const VkResult result = vkCreateBuffer(checked.handle(), &create, nullptr, &buffer);
  if (result == VK_SUCCESS) vkDestroyBuffer(checked.handle(), buffer, nullptr);
  EXPECT_FALSE(checked.validation_messages().empty());
}

}  // namespace tachylite::vulkan
