#include "base/memory.h"

#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string_view>

#include "base/error.h"

namespace tachylite {

namespace {

/// What the line that begins with `name` says, in bytes; 0 without it.
uint64_t read_kibibytes(const char* path, std::string_view name) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(name)) return 1024 * std::strtoull(line.c_str() + name.size(), nullptr, 10);
  return 0;
}

}  // namespace

uint64_t available_memory() {
  uint64_t bytes = std::numeric_limits<uint64_t>::max();
  if (const uint64_t known = read_kibibytes("/proc/meminfo", "MemAvailable:"); known > 0) bytes = known;
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

void prefer_huge_pages(void* begin, uint64_t bytes) {
  constexpr uint64_t kPage = 4096, kHugePage = 2 << 20;
  if (bytes < kHugePage) return;
  const auto address = reinterpret_cast<uintptr_t>(begin), first = (address + kPage - 1) / kPage * kPage;
  madvise(reinterpret_cast<void*>(first), (address + bytes - first) / kPage * kPage, MADV_HUGEPAGE);
}

uint64_t peak_memory() { return read_kibibytes("/proc/self/status", "VmHWM:"); }

void forget_peak_memory() {
  malloc_trim(0);  // what is free, but held, would count
  std::ofstream("/proc/self/clear_refs") << 5;  // proc(5): 5 resets VmHWM
}

}  // namespace tachylite
