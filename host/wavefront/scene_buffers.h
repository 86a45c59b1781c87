#pragma once

#include <vector>

#include "pack/pack_scene.h"
#include "vulkan/kernel.h"
#include "wavefront/wave_tracer.h"

namespace tachylite {

/// One buffer of the scene or of the paths: what it is called, where it is bound, how large it is.
struct BufferPlan {
  const char* name;
  std::vector<vulkan::Binding> bindings;  // without the buffer; one buffer may have a texel and a storage binding
  const void* data = nullptr;             // uploaded when the buffer is made; null: left as it is
  uint64_t bytes = 0;                     // 0: the scene does not need it
  vulkan::Domain domain = vulkan::Domain::kDevice;
  bool pages = false;                     // `data` lies alone in its pages: a buffer may be over it
};

/// The buffers that a scene needs, each once, before anything is allocated. `listed`: the wave's pixels stand in a list.
/// With plan.baked (one kernel for whole paths) there is no tree, no path state, no queue.
std::vector<BufferPlan> plan_buffers(const vulkan::DeviceInfo& device, const PackedScene& scene,
                                     const gpu::RenderParams& params, const WavePlan& plan, bool listed);

/// Whether kernels read tree and paths from storage buffers: where that is faster, and the device has such that hold the
/// tree.
bool reads_storage(const vulkan::DeviceInfo& device, const PackedScene& scene);

}  // namespace tachylite
