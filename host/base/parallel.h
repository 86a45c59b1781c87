#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace tachylite {

/// Calls body(first, last) on disjoint subranges that cover [begin, end), each of at most `grain` items, on the
/// threads of set_thread_count. Which thread gets which subrange is not determined: a body must write only what
/// belongs to its own items. The first exception is rethrown after all subranges have ended.
void parallel_for(size_t begin, size_t end, size_t grain, const std::function<void(size_t, size_t)>& body);

/// A grain for loops over vertices, triangles or nodes that do little for each.
constexpr size_t kMeshGrain = size_t{1} << 14;

template <class T>
void parallel_fill(std::span<T> items, const T& value) {
  parallel_for(0, items.size(), kMeshGrain, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) items[i] = value;
  });
}

/// Calls body(i) for each i below `count`, likewise; the exception that is rethrown is that of the least i.
void parallel_for_each(size_t count, const std::function<void(size_t)>& body);

/// join(...join(join(T(), part of the first subrange), part of the second)...): subranges of kMeshGrain items, whatever
/// the number of threads, so that rounding does not depend on it.
template <class T, class Part, class Join>
T parallel_reduce(size_t begin, size_t end, const Part& part, const Join& join) {
  std::vector<T> parts((end - begin + kMeshGrain - 1) / kMeshGrain);
  parallel_for(0, parts.size(), 1, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i)
      parts[i] = part(begin + i * kMeshGrain, std::min(begin + (i + 1) * kMeshGrain, end));
  });
  T all{};
  for (const T& p : parts) all = join(all, p);
  return all;
}

/// For results whose place depends on those before: write(first, last, at) writes those of a subrange, of which there
/// are count(first, last), from place `at` on. Returns how many there are in all.
size_t parallel_scan(size_t items, const std::function<size_t(size_t, size_t)>& count,
                     const std::function<void(size_t, size_t, size_t)>& write);

/// Runs both, perhaps at the same time; returns after both have ended.
void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b);

/// Calls body(i) for each i below `count`, each on a thread of its own, whatever the number of threads below: for what
/// mostly waits for a device of its own. The exception that is rethrown is that of the least i.
void run_side_by_side(size_t count, const std::function<void(size_t)>& body);

/// Number of threads of all others; 0 means one per core. Takes effect for calls made after it.
void set_thread_count(int count);
int thread_count();

}  // namespace tachylite
