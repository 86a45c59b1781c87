#pragma once

#include <vector>

#include "bench/embree_scene.h"
#include "bench/scenes.h"

namespace tachylite::bench {

/// One set of rays to be traced and timed.
struct RaySet {
  std::string name;      // primary, diffuse, shuffled or shadow
  bool any_hit = false;  // shadow: only whether something is hit
  bool coherent = false; // primary: traced without refilling lanes
  std::vector<test::TraceRay> rays;
};

/// primary: one ray a pixel, in tiles of 8 x 8. diffuse: a cosine-distributed bounce at each primary hit, in the
/// same order. shuffled: the diffuse rays in random order. shadow: from each primary hit to a uniform point of the
/// light. Origins are moved off the surface by 1e-4 of the distance seen, so that no ray starts on a triangle.
std::vector<RaySet> make_ray_sets(const BenchScene& scene, const EmbreeScene& embree);

}  // namespace tachylite::bench
