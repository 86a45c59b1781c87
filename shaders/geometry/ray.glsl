// Rays and hits of the trace kernels.
#ifndef TACHYLITE_GEOMETRY_RAY_GLSL
#define TACHYLITE_GEOMETRY_RAY_GLSL
#include "shared/bvh.h"

// Hits at t in (0, tmax] of o + t d count; d is of any length. A triangle that is named by `ignored` or
// `ignored_target` (as hits name them; kNoHit: none) does not count. A curved shape named by `ignored` is one that the
// ray leaves: of its two roots the one at the origin does not count.
struct TraceRay {
  vec3 o, d;
  float tmax;
  uint ignored, ignored_target;
};

struct TraceHit {
  uint id;       // 2 * leaf + triangle, kNoHit
  float b1, b2;  // barycentrics in the leaf's order of vertices; 0 on curved shapes
  float t;       // tmax where nothing is hit
};

#endif
