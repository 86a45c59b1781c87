#include "base/parallel.h"

#include <exception>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/partitioner.h>

namespace tachylite {
namespace {
std::unique_ptr<tbb::global_control> thread_limit;

// body(i), whose exception goes to failures[i].
void try_body(const std::function<void(size_t)>& body, size_t i, std::vector<std::exception_ptr>& failures) {
  try {
    body(i);
  } catch (...) {
    failures[i] = std::current_exception();
  }
}

void rethrow_first(const std::vector<std::exception_ptr>& failures) {
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace

void parallel_for(size_t begin, size_t end, size_t grain, const std::function<void(size_t, size_t)>& body) {
  tbb::parallel_for(
      tbb::blocked_range<size_t>(begin, end, grain),
      [&](const tbb::blocked_range<size_t>& r) { body(r.begin(), r.end()); }, tbb::simple_partitioner());
}

void parallel_for_each(size_t count, const std::function<void(size_t)>& body) {
  std::vector<std::exception_ptr> failures(count);
  parallel_for(0, count, 1, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) try_body(body, i, failures);
  });
  rethrow_first(failures);
}

void run_side_by_side(size_t count, const std::function<void(size_t)>& body) {
  std::vector<std::exception_ptr> failures(count);
  {
    std::vector<std::jthread> threads;
    for (size_t i = 1; i < count; ++i) threads.emplace_back([&, i] { try_body(body, i, failures); });
    if (count > 0) try_body(body, 0, failures);
  }
  rethrow_first(failures);
}

size_t parallel_scan(size_t items, const std::function<size_t(size_t, size_t)>& count,
                     const std::function<void(size_t, size_t, size_t)>& write) {
  std::vector<size_t> places((items + kMeshGrain - 1) / kMeshGrain);
  const auto for_subranges = [&](const auto& body) {
    parallel_for_each(places.size(), [&](size_t i) {
      body(i * kMeshGrain, std::min((i + 1) * kMeshGrain, items), places[i]);
    });
  };
  for_subranges([&](size_t first, size_t last, size_t& place) { place = count(first, last); });
  size_t all = 0;
  for (size_t& place : places) all += std::exchange(place, all);
  for_subranges(write);
  return all;
}

void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b) { tbb::parallel_invoke(a, b); }

void set_thread_count(int count) {
  thread_limit.reset();
  if (count > 0)
    thread_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                         static_cast<size_t>(count));
}

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace tachylite
