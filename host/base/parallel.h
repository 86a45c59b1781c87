#pragma once

#include <cstddef>
#include <functional>

namespace tachylite {

/// Calls body(first, last) on disjoint subranges that cover [begin, end), each of at most `grain` items, on the
/// threads of set_thread_count. Which thread gets which subrange is not determined: a body must write only what
/// belongs to its own items. The first exception is rethrown after all subranges have ended.
void parallel_for(size_t begin, size_t end, size_t grain, const std::function<void(size_t, size_t)>& body);

/// A grain for loops over vertices, triangles or nodes that do little for each.
constexpr size_t kMeshGrain = size_t{1} << 14;

/// Calls body(i) for each i below `count`, likewise; the exception that is rethrown is that of the least i.
void parallel_for_each(size_t count, const std::function<void(size_t)>& body);

/// Runs both, perhaps at the same time; returns after both have ended.
void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b);

/// Number of threads of everything above; 0 means one per core. Takes effect for calls made after it.
void set_thread_count(int count);
int thread_count();

}  // namespace tachylite
