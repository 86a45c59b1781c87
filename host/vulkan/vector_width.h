#pragma once

namespace tachylite::vulkan {

/// Asks lavapipe for vectors of 512 bits instead of 256, where the CPU has AVX-512: kernels that follow whole paths
/// through baked geometry need 0.6 to 0.8 times the CPU time then, a scene with a tree 1.5 to 1.8 times
/// (tests/bench/README.md).
/// Lavapipe reads LP_NATIVE_VECTOR_WIDTH once a process, so this must precede the first Device; its shader cache
/// confuses widths, so that this one gets a folder of its own ("vectors-512" in MESA_SHADER_CACHE_DIR, else
/// "tachylite-vectors-512" in XDG_CACHE_HOME or ~/.cache). Without such a folder, or where the user has set the width,
/// nothing changes. Images do not depend on it, bit for bit. Other drivers take no notice.
void prefer_wide_vectors();

}  // namespace tachylite::vulkan
