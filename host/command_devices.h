#pragma once

namespace tachylite {

/// Lists the Vulkan devices with driver, type and the limits that matter; on stdout. Returns the exit code: 1
/// when no device can run us.
int run_devices();

}  // namespace tachylite
