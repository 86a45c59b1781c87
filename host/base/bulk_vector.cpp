#include "base/bulk_vector.h"

#include <sys/mman.h>

#include "base/memory.h"

namespace tachylite {
namespace {

constexpr size_t kHugePage = size_t{2} << 20;

size_t whole_pages(size_t bytes) { return (bytes + kHugePage - 1) / kHugePage * kHugePage; }

bool is_small(size_t bytes) { return bytes < kHugePage / 2; }

}  // namespace

void* allocate_bulk(size_t bytes) {
  if (is_small(bytes)) return ::operator new(bytes);
  void* memory = mmap(nullptr, whole_pages(bytes), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  prefer_huge_pages(memory, whole_pages(bytes));
  return memory;
}

void free_bulk(void* memory, size_t bytes) {
  if (is_small(bytes))
    ::operator delete(memory);
  else
    munmap(memory, whole_pages(bytes));
}

}  // namespace tachylite
