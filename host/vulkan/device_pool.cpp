#include "vulkan/device_pool.h"

#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

namespace tachylite::vulkan {
namespace {

constexpr const char* kThreads = "LP_NUM_THREADS";

// Sets a variable of the environment; puts it back in the end.
class VariableScope {
 public:
  VariableScope(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~VariableScope() {
    if (before_)
      setenv(name_, before_->c_str(), 1);
    else
      unsetenv(name_);
  }
  VariableScope(const VariableScope&) = delete;
  VariableScope& operator=(const VariableScope&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

}  // namespace

uint32_t llvmpipe_threads() {
  const char* const given = std::getenv(kThreads);
  const long threads = given ? std::strtol(given, nullptr, 10) : static_cast<long>(std::thread::hardware_concurrency());
  return threads > 0 ? static_cast<uint32_t>(threads) : 1;
}

DevicePool::Devices DevicePool::side_by_side(uint32_t count) {
  std::vector<std::unique_ptr<Device>>& devices = opened_[count];
  for (auto i = static_cast<uint32_t>(devices.size()); i < count; ++i) {
    std::optional<VariableScope> scope;
    if (count > 1) {
      const uint32_t all = llvmpipe_threads(), threads = all / count + (i < all % count ? 1 : 0);
      // 0: no thread beside the one that submits, which then works itself.
      scope.emplace(kThreads, std::to_string(threads > 1 ? threads : 0));
    }
    devices.push_back(std::make_unique<Device>(options_));
  }
  return devices;
}

std::vector<std::string> DevicePool::validation_messages() const {
  std::vector<std::string> all;
  for (const auto& [count, devices] : opened_)
    for (const auto& device : devices) {
      const std::vector<std::string> messages = device->validation_messages();
      all.insert(all.end(), messages.begin(), messages.end());
    }
  return all;
}

}  // namespace tachylite::vulkan
