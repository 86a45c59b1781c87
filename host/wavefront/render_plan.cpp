#include "wavefront/render_plan.h"

#include <algorithm>
#include <limits>

#include "shared/counters.h"
#include "shared/path_state.h"
#include "wavefront/adaptive_sampling.h"
#include "wavefront/scene_buffers.h"
#include "wavefront/wave_tracer.h"

namespace tachylite {
namespace {

// Paths in flight. More gain little: caches of a CPU hold few of them, and a GPU has no more lanes.
constexpr uint64_t kPathsOfCpu = 1u << 18, kPathsOfGpu = 1u << 22;
constexpr uint64_t kShareOfMemory = 8;  // all of them take at most an eighth of a GPU's
constexpr uint64_t kLeastOfCpus = 1u << 16;  // of each of several devices

// Several devices: at most so many, each with so many paths to trace at least for each kernel of a class of materials,
// and for all others together, as each compiles them; renders that may last so long.
constexpr uint64_t kMostDevices = 8, kPathsWorthClass = 1u << 17;
constexpr double kSecondsWorthDevices = 3;
constexpr uint64_t kShareOfScene = 2;  // all devices together take at most half of the memory

uint32_t default_paths(const PackedScene& scene, const vulkan::DeviceInfo& device) {
  if (device.type == VK_PHYSICAL_DEVICE_TYPE_CPU) return kPathsOfCpu;
  const uint64_t state = gpu::kPathRowsMedia * sizeof(glm::vec4), shadow = gpu::kShadowRowsMedia * sizeof(glm::vec4);
  const uint64_t queues = (gpu::kQueueSurface + scene.features.classes.size() + 1) * sizeof(uint32_t);
  const uint64_t fit = std::min({device.device_memory / kShareOfMemory / (state + shadow + queues),
                                 device.max_storage_buffer_range / std::max(state, queues),
                                 device.max_texel_buffer_elements * sizeof(uint32_t) / queues,
                                 device.max_texel_buffer_elements * sizeof(glm::vec4) / state});
  return static_cast<uint32_t>(std::clamp(fit, kPathsOfCpu, kPathsOfGpu));
}

}  // namespace

RenderOptions with_defaults(RenderOptions options, const PackedScene& scene, const vulkan::DeviceInfo& device,
                            uint32_t devices) {
  options.adaptive = options.adaptive && pilot_samples(options.samples) < options.samples;
  if (options.max_paths == 0)
    options.max_paths = std::max(default_paths(scene, device) / devices, static_cast<uint32_t>(kLeastOfCpus));
  else
    options.max_paths = std::max(options.max_paths / devices, 1u);
  return options;
}

uint64_t MemoryPlan::total() const {
  uint64_t sum = 0;
  for (const Entry& e : buffers) sum += e.bytes;
  return sum;
}

uint32_t count_devices(const vulkan::DeviceInfo& device, const PackedScene& scene, const RenderOptions& options) {
  const uint64_t paths = uint64_t{scene.params.width} * scene.params.height * options.samples;
  const uint64_t worth = paths / (kPathsWorthClass * (1 + scene.features.classes.size()));
  const bool short_one = worth < 2 || (options.time_limit > 0 && options.time_limit < kSecondsWorthDevices);
  if (device.driver != "llvmpipe" || short_one || WavePlan(scene, options).baked) return 1;
  const uint64_t memory = Renderer::plan_memory(device, scene, options, 2).total();
  const uint64_t count = std::min({uint64_t{vulkan::llvmpipe_threads()}, kMostDevices, worth,
                                   device.device_memory / kShareOfScene / std::max(memory, uint64_t{1})});
  return static_cast<uint32_t>(std::max(count, uint64_t{1}));
}

MemoryPlan Renderer::plan_memory(const vulkan::DeviceInfo& device, const PackedScene& scene,
                                 const RenderOptions& options, uint32_t devices) {
  MemoryPlan plan;
  const WavePlan waves(scene, with_defaults(options, scene, device, devices));
  gpu::RenderParams params = scene.params;
  params.capacity = waves.capacity;
  for (const BufferPlan& p : plan_buffers(device, scene, params, waves, options.adaptive)) {
    uint64_t limit = std::numeric_limits<uint64_t>::max();
    for (const vulkan::Binding& b : p.bindings) limit = std::min(limit, vulkan::largest_buffer(device, b));
    if (p.bytes > 0) plan.buffers.push_back({p.name, p.bytes, limit});
  }
  return plan;
}

}  // namespace tachylite
