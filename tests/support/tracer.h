#pragma once

#include <memory>
#include <span>
#include <vector>

#include "accel/bvh.h"
#include "pack/bake_geometry.h"
#include "vulkan/commands.h"

namespace tachylite::test {

/// Two rows of vec4. Hits at t in (0, t_max] count; the triangle named by `ignore` (as hits name them, kNoHit: none)
/// does not.
struct TraceRay {
  glm::vec3 origin{0};
  float t_max = 0;
  glm::vec3 direction{0};
  uint32_t ignore = gpu::kNoHit;
};

/// One row. What t is without a hit: t_max.
struct TraceHit {
  uint32_t id = gpu::kNoHit;  // 2 * leaf + triangle; in baked geometry the primitive's rows
  float b1 = 0, b2 = 0;       // barycentrics of the leaf's second and third vertex of that triangle
  float t = 0;
};

/// The traversal of shaders/geometry/bvh.glsl on a device: closest hits or any hits, with lanes refilled
/// (trace_rays.glsl) or one ray a lane. Of baked geometry the tests of baked.glsl, one ray a lane, in either form.
class Tracer {
 public:
  enum class Query { kClosest, kAny };
  enum class Form { kRefill, kPlain };

  Tracer(vulkan::Device& device, const Bvh8& bvh);
  Tracer(vulkan::Device& device, const BakedGeometry& baked);
  ~Tracer();

  void set_rays(std::span<const TraceRay> rays);
  void run(Query query, Form form = Form::kRefill);  // waits
  std::vector<TraceHit> hits() const;

  std::vector<TraceHit> trace(std::span<const TraceRay> rays, Query query, Form form = Form::kRefill) {
    set_rays(rays);
    run(query, form);
    return hits();
  }

 private:
  struct Kernels;
  vulkan::Device& device_;
  vulkan::Commands commands_;
  bool baked_ = false;
  vulkan::SpecializationConstants constants_;
  vulkan::Buffer nodes_, leaves_, rays_, hits_;
  uint32_t count_ = 0;
  std::unique_ptr<Kernels> kernels_;
};

}  // namespace tachylite::test
