#pragma once

#include <memory>

#include "bench/embree_scene.h"
#include "pack/pack_scene.h"
#include "support/pcg32.h"

namespace tachylite::bench {

/// A path tracer as one writes it first: a loop a path, one ray at a time, rtcIntersect1 and rtcOccluded1. For scenes of
/// diffuse triangles and one emitting parallelogram, seen through a pinhole; box filter.
class EmbreePaths {
 public:
  EmbreePaths(const Scene& scene, const PackedScene& packed);

  /// Mean radiance of the image, one path a sample of a pixel; paths of at most `max_depth` edges.
  glm::dvec3 render(uint32_t samples, uint32_t max_depth, uint64_t seed, int threads) const;

 private:
  struct Surface {
    glm::vec3 v0, normal;     // normal: unit, geometric
    glm::vec3 reflectance, Le;  // Le: on the side of the normal
  };
  glm::vec3 trace_path(glm::vec3 o, glm::vec3 d, uint32_t max_depth, test::Pcg32& random) const;

  gpu::CameraParams camera_;
  uint32_t width_, height_;
  std::vector<Surface> surfaces_;  // by triangle
  std::unique_ptr<EmbreeScene> embree_;
  glm::vec3 light_corner_{0}, light_u_{0}, light_v_{0}, light_normal_{0}, light_Le_{0};
  float light_area_ = 0;
};

}  // namespace tachylite::bench
