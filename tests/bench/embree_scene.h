#pragma once

#include <algorithm>
#include <atomic>
#include <span>
#include <thread>
#include <vector>

#include <embree3/rtcore.h>

#include "support/test_mesh.h"
#include "support/tracer.h"

namespace tachylite::bench {

RTCRay to_embree(const test::TraceRay& ray);

/// Blocks of rays, taken by the threads in turn.
template <class Body>
void for_blocks(size_t count, int threads, const Body& body) {
  constexpr size_t kBlock = 1024;
  std::atomic<size_t> next = 0;
  const auto work = [&] {
    for (size_t first; (first = next.fetch_add(kBlock)) < count;) body(first, std::min(first + kBlock, count));
  };
  std::vector<std::jthread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
}

/// The yardstick: a mesh in Embree, built for speed of tracing (RTC_BUILD_QUALITY_HIGH).
class EmbreeScene {
 public:
  explicit EmbreeScene(const test::TestMesh& mesh);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene handle() const { return scene_; }
  /// rtcIntersect1 and rtcOccluded1 of each ray, on `threads` threads. Hit ids are triangle numbers (kNoHit: none);
  /// an occluded ray has id 0. `ignore` is not looked at.
  void closest(std::span<const test::TraceRay> rays, std::span<test::TraceHit> hits, int threads) const;
  void occluded(std::span<const test::TraceRay> rays, std::span<test::TraceHit> hits, int threads) const;

 private:
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace tachylite::bench
