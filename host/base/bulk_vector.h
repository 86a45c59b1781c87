#pragma once

#include <cstddef>
#include <new>
#include <type_traits>
#include <vector>

namespace tachylite {

/// Memory in pages of 2 MiB, where Linux has any and there is use for them: they take a hundredth of the page faults.
void* allocate_bulk(size_t bytes);
void free_bulk(void* memory, size_t bytes);
/// Whether allocations of so many bytes or more begin and end with a page.
bool owns_pages(size_t bytes);

/// Memory of allocate_bulk.
template <class T>
struct PageAllocator {
  using value_type = T;

  PageAllocator() = default;
  template <class U>
  PageAllocator(const PageAllocator<U>&) {}
  bool operator==(const PageAllocator&) const = default;

  T* allocate(size_t count) { return static_cast<T*>(allocate_bulk(count * sizeof(T))); }
  void deallocate(T* memory, size_t count) { free_bulk(memory, count * sizeof(T)); }
};

/// The same; elements have no value until they are given one, so that the threads that do so are the first to touch
/// their memory.
template <class T>
struct BulkAllocator : PageAllocator<T> {
  BulkAllocator() = default;
  template <class U>
  BulkAllocator(const BulkAllocator<U>&) {}
  bool operator==(const BulkAllocator&) const = default;

  template <class U>
  void construct(U* element) {
    ::new (static_cast<void*>(element)) U;
  }
};

/// For arrays that devices may share (vulkan/buffer.h).
template <class T>
using PageVector = std::vector<T, PageAllocator<T>>;

/// For large arrays whose elements are all written after resize().
template <class T>
using BulkVector = std::vector<T, BulkAllocator<T>>;

/// Whether such a vector's elements lie alone in their pages.
template <class Vector>
bool owns_pages(const Vector& vector) {
  using T = typename Vector::value_type;
  return std::is_base_of_v<PageAllocator<T>, typename Vector::allocator_type> && owns_pages(vector.size() * sizeof(T));
}

}  // namespace tachylite
