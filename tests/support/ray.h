#pragma once

#include <glm/glm.hpp>

#include "shared/bvh.h"

namespace tachylite::test {

/// What the trace kernels of the tests and of the bench read: two rows of vec4. Hits at t in [0, t_max] count; the
/// primitive named by `ignore` (as hits name them, kNoHit: none) is left out.
struct Ray {
  glm::vec3 origin{0};
  float t_max = 0;
  glm::vec3 direction{0};
  uint32_t ignore = gpu::kNoHit;
};

/// What they write: one row.
struct Hit {
  uint32_t id = gpu::kNoHit;  // 2 * leaf + triangle
  float b1 = 0, b2 = 0;       // barycentrics of the leaf's second and third vertex of that triangle
  float t = 0;
};

}  // namespace tachylite::test
