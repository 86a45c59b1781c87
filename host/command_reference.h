#pragma once

#include "command_render.h"

namespace tachylite {

/// Renders on the CPU reference. Returns the exit code. Device, sampler and number of paths do not matter.
int run_reference(const RenderArguments& arguments);

}  // namespace tachylite
