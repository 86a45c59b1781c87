#include "base/memory.h"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "base/error.h"

namespace tachylite {

uint64_t available_memory() {
  uint64_t bytes = std::numeric_limits<uint64_t>::max();
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);)
    if (uint64_t kib = 0; line.starts_with("MemAvailable:")) {
      kib = std::strtoull(line.c_str() + sizeof "MemAvailable:", nullptr, 10);
      if (kib > 0) bytes = 1024 * kib;
    }
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    bytes = std::min(bytes, static_cast<uint64_t>(limit.rlim_cur));
  return bytes;
}

void require_memory(const FileLocation& where, const std::string& what, uint64_t bytes) {
  constexpr uint64_t kAlways = 16 << 20;  // not worth asking
  if (bytes <= kAlways) return;
  if (const uint64_t available = available_memory(); bytes > available)
    throw InputError(where, fmt::format("{} needs {} bytes of memory; {} are available", what, bytes, available));
}

}  // namespace tachylite
