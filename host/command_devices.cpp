#include "command_devices.h"

#include <fmt/format.h>

#include "base/error.h"
#include "command_device.h"
#include "vulkan/device.h"

namespace tachylite {

int run_devices() {
  bool any = false;
  for (const vulkan::DeviceInfo& device : vulkan::list_devices()) {
    any |= device.unusable.empty();
    fmt::print("{}: {} ({})\n", device.index, device.name, device_type(device.type));
    fmt::print("   driver {} {}, Vulkan {}\n", device.driver, device.driver_version, device.api_version);
    fmt::print("   memory {}, storage buffer {}, texel buffer {} texels, uniform buffer {}\n",
               format_bytes(device.device_memory), format_bytes(device.max_storage_buffer_range),
               device.max_texel_buffer_elements, format_bytes(device.max_uniform_buffer_range));
    fmt::print(
        "   subgroup {}, workgroup {} invocations, {} workgroups, push constants {} bytes, timestamps {}\n",
        device.subgroup_size, device.max_workgroup_invocations, device.max_workgroup_count_x,
        device.max_push_constants,
        device.timestamp_period_ns > 0 ? fmt::format("{:g} ns", device.timestamp_period_ns) : "none");
    if (!device.unusable.empty()) fmt::print("   cannot be used: {}\n", device.unusable);
  }
  if (!any) throw RenderError("no Vulkan device can run this program");
  return 0;
}

}  // namespace tachylite
