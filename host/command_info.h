#pragma once

#include <string>

#include "command_scene.h"
#include "wavefront/renderer.h"

namespace tachylite {

struct InfoArguments {
  SceneArguments scene;
  std::string device;
  uint32_t max_paths = RenderOptions{}.max_paths;
};

/// Prints on stdout what the scene holds and needs: features, BVH, memory against the device's limits.
/// Renders nothing, and does without a device where there is none.
int run_info(const InfoArguments& arguments);

}  // namespace tachylite
