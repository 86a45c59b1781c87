#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace tachylite {

/// Memory in pages of 2 MiB, where Linux has any and there is use for them: they take a hundredth of the page faults.
void* allocate_bulk(size_t bytes);
void free_bulk(void* memory, size_t bytes);

/// Elements have no value until they are given one, so that the threads that do so are the first to touch their memory.
template <class T>
struct BulkAllocator {
  using value_type = T;

  BulkAllocator() = default;
  template <class U>
  BulkAllocator(const BulkAllocator<U>&) {}
  bool operator==(const BulkAllocator&) const = default;

  T* allocate(size_t count) { return static_cast<T*>(allocate_bulk(count * sizeof(T))); }
  void deallocate(T* memory, size_t count) { free_bulk(memory, count * sizeof(T)); }
  template <class U>
  void construct(U* element) {
    ::new (static_cast<void*>(element)) U;
  }
};

/// For large arrays whose elements are all written after resize().
template <class T>
using BulkVector = std::vector<T, BulkAllocator<T>>;

}  // namespace tachylite
