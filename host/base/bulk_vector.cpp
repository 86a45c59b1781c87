#include "base/bulk_vector.h"

#include <sys/mman.h>

#include "base/memory.h"

namespace tachylite {
namespace {

constexpr size_t kHugePage = size_t{2} << 20;

size_t whole_pages(size_t bytes) { return (bytes + kHugePage - 1) / kHugePage * kHugePage; }

}  // namespace

bool owns_pages(size_t bytes) { return bytes >= kHugePage / 2; }

void* allocate_bulk(size_t bytes) {
  if (!owns_pages(bytes)) return ::operator new(bytes);
  void* memory = mmap(nullptr, whole_pages(bytes), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  prefer_huge_pages(memory, whole_pages(bytes));
  return memory;
}

void free_bulk(void* memory, size_t bytes) {
  if (owns_pages(bytes))
    munmap(memory, whole_pages(bytes));
  else
    ::operator delete(memory);
}

}  // namespace tachylite
