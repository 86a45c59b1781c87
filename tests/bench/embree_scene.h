#pragma once

#include <span>

#include <embree3/rtcore.h>

#include "support/test_mesh.h"
#include "support/tracer.h"

namespace tachylite::bench {

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
