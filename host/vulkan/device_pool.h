#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "vulkan/device.h"

namespace tachylite::vulkan {

/// Threads that Mesa's llvmpipe has: LP_NUM_THREADS, where the environment has it, else one a core.
uint32_t llvmpipe_threads();

/// Devices that are alike, opened when they are asked for, to work one at a time or side by side.
class DevicePool {
 public:
  using Devices = std::span<const std::unique_ptr<Device>>;

  explicit DevicePool(DeviceOptions options) : options_(std::move(options)) {}

  /// `count` devices; the same ones each time. Of Mesa's llvmpipe each has its part of llvmpipe_threads(): llvmpipe
  /// gives each of its threads an equal part of a dispatch and waits for the last, so that they idle less where each
  /// works for a device of its own (tests/bench/README.md). Sets LP_NUM_THREADS while it opens several: meanwhile no
  /// other thread may read the environment. Throws as Device does.
  Devices side_by_side(uint32_t count);
  Device& one() { return *side_by_side(1)[0]; }
  /// Validation messages of all.
  std::vector<std::string> validation_messages() const;

 private:
  DeviceOptions options_;
  std::map<uint32_t, std::vector<std::unique_ptr<Device>>> opened_;
};

}  // namespace tachylite::vulkan
