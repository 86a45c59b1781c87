#pragma once

#include <optional>
#include <string>

#include "command_scene.h"
#include "wavefront/renderer.h"

namespace tachylite {

struct VerifyArguments {
  SceneArguments scene;
  std::optional<uint32_t> seed;
  double time = 0;  // seconds; 0: none
  std::string device;
  SamplerKind sampler = SamplerKind::kSobol;
  Guiding guiding = Guiding::kAuto;
  uint32_t max_paths = RenderOptions{}.max_paths;
  bool quiet = false;
};

/// Device against reference, with as many samples as it takes (image/verify.h). Figures and verdict on
/// stdout. Returns the exit code: 0 agree, 1 differ or no verdict in time, 130 interrupted.
int run_verify(const VerifyArguments& arguments);

}  // namespace tachylite
