#pragma once

#include "pack/pack_scene.h"
#include "vulkan/device.h"
#include "wavefront/renderer.h"

namespace tachylite {

/// What is decided before anything is allocated, beside count_devices() and Renderer::plan_memory(): the options of
/// each of so many devices, with what they leave open.
RenderOptions with_defaults(RenderOptions options, const PackedScene& scene, const vulkan::DeviceInfo& device,
                            uint32_t devices);

}  // namespace tachylite
