#pragma once

namespace tachylite::test {

/// From now on, pipelines of one kernel, its constants and its bindings are made once and kept until
/// forget_pipelines(): a driver takes most of a second for those of one scene. To be called when all devices have been
/// opened; puts itself between volk and the driver.
void keep_pipelines();
/// Destroys all that are kept; no renderer may exist.
void forget_pipelines();

}  // namespace tachylite::test
