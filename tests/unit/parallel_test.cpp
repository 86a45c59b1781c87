// base/parallel and base/bulk_vector: loops over subranges that lose nothing and do not depend on the threads.

#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <barrier>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "base/bulk_vector.h"

namespace tachylite {
namespace {

// None, one, around a subrange, several and a rest.
constexpr size_t kCounts[] = {0, 1, kMeshGrain - 1, kMeshGrain, kMeshGrain + 1, 5 * kMeshGrain + 17};

class ForThreads : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override { set_thread_count(GetParam()); }
  void TearDown() override { set_thread_count(0); }
};

TEST_P(ForThreads, FillsAll) {
  for (const size_t count : kCounts) {
    BulkVector<uint32_t> items(count);
    parallel_fill<uint32_t>(items, 7);
    EXPECT_EQ(std::accumulate(items.begin(), items.end(), size_t{0}), 7 * count);
  }
}

// Sums of floats tell in which order they were made.
TEST_P(ForThreads, ReducesInOneOrder) {
  for (const size_t count : kCounts) {
    const auto sum = [](size_t first, size_t last) {
      float part = 0;
      for (size_t i = first; i < last; ++i) part += 1 / static_cast<float>(i + 1);
      return part;
    };
    float expected = 0;
    for (size_t first = 3; first < count + 3; first += kMeshGrain)
      expected += sum(first, std::min(first + kMeshGrain, count + 3));
    EXPECT_EQ(parallel_reduce<float>(3, count + 3, sum, std::plus()), expected);
  }
}

TEST_P(ForThreads, ScanKeepsTheOrder) {
  const auto is_wanted = [](size_t i) { return i * 2654435761u % 7 < 3; };
  for (const size_t count : kCounts) {
    std::vector<size_t> expected;
    for (size_t i = 0; i < count; ++i)
      if (is_wanted(i)) expected.push_back(i);
    std::vector<size_t> found(count);
    found.resize(parallel_scan(
        count,
        [&](size_t first, size_t last) {
          size_t wanted = 0;
          for (size_t i = first; i < last; ++i) wanted += is_wanted(i);
          return wanted;
        },
        [&](size_t first, size_t last, size_t at) {
          for (size_t i = first; i < last; ++i)
            if (is_wanted(i)) found[at++] = i;
        }));
    EXPECT_EQ(found, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Parallel, ForThreads, ::testing::Values(1, 2, 5));

// Across the size from which memory is mapped.
TEST(BulkVector, LargeOnesOwnTheirPages) {
  EXPECT_FALSE(owns_pages(BulkVector<char>(1000)));
  EXPECT_FALSE(owns_pages(std::vector<char>(size_t{4} << 20)));
  const PageVector<char> zeros(size_t{3} << 20);
  ASSERT_TRUE(owns_pages(zeros));
  EXPECT_EQ(reinterpret_cast<uintptr_t>(zeros.data()) % 4096, 0u);
  EXPECT_EQ(std::ranges::count(zeros, 0), 3 << 20);
}

TEST(RunSideBySide, RunsAllAtTheSameTime) {
  std::barrier all(5);  // would wait for ever in turn
  std::vector<int> done(5);
  run_side_by_side(5, [&](size_t i) {
    all.arrive_and_wait();
    done[i] = static_cast<int>(i);
  });
  EXPECT_EQ(done, (std::vector<int>{0, 1, 2, 3, 4}));
  run_side_by_side(0, [](size_t) { FAIL(); });
}

TEST(RunSideBySide, RethrowsTheFirstAfterAllHaveEnded) {
  std::atomic<int> ended = 0;
  try {
    run_side_by_side(4, [&](size_t i) {
      ++ended;
      if (i >= 1) throw std::runtime_error(std::to_string(i));
    });
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "1");
  }
  EXPECT_EQ(ended, 4);
}

TEST(BulkVector, KeepsItsElementsAsItGrows) {
  BulkVector<uint64_t> items;
  for (uint64_t i = 0; i < 1 << 20; ++i) items.push_back(i);
  for (uint64_t i = 0; i < 1 << 20; ++i) ASSERT_EQ(items[i], i);
  const BulkVector<uint64_t> copy = items;
  items.resize(3);
  items.shrink_to_fit();
  EXPECT_EQ(items, (BulkVector<uint64_t>{0, 1, 2}));
  EXPECT_EQ(copy.back(), (1 << 20) - 1);
}

}  // namespace
}  // namespace tachylite
