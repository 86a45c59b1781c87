#include "vulkan/vector_width.h"

#include <cstdlib>
#include <filesystem>

namespace tachylite::vulkan {
namespace {

bool has_avx512() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

std::filesystem::path cache_of_wide_kernels() {
  const auto folder = [](const char* variable) {
    const char* value = std::getenv(variable);
    return std::filesystem::path(value ? value : "");
  };
  if (const auto chosen = folder("MESA_SHADER_CACHE_DIR"); !chosen.empty()) return chosen / "vectors-512";
  if (const auto caches = folder("XDG_CACHE_HOME"); !caches.empty()) return caches / "tachylite-vectors-512";
  if (const auto home = folder("HOME"); !home.empty()) return home / ".cache" / "tachylite-vectors-512";
  return {};
}

}  // namespace

void prefer_wide_vectors() {
  if (std::getenv("LP_NATIVE_VECTOR_WIDTH") || !has_avx512()) return;
  const std::filesystem::path cache = cache_of_wide_kernels();
  std::error_code error;
  if (!cache.empty()) std::filesystem::create_directories(cache, error);
  if (!std::filesystem::is_directory(cache, error)) return;
  setenv("MESA_SHADER_CACHE_DIR", cache.c_str(), 1);
  setenv("LP_NATIVE_VECTOR_WIDTH", "512", 1);
}

}  // namespace tachylite::vulkan
