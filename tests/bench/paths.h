#pragma once

#include <map>
#include <string>

namespace tachylite::bench {

/// Paths a second of the Cornell box of scenes/cornell-box (512 x 512, paths of up to 8 edges, no roulette, next-event
/// estimation and BSDF sampling with MIS): the renderer against a plain path tracer with Embree's single-ray queries on
/// 2 threads. Both run in turn; each figure is that of the repetition with least CPU time, as 2 * paths / CPU seconds.
struct PathsResult {
  double mpaths = 0, embree_mpaths = 0;
  double mrays = 0;       // million rays a second of ours, with all the work of paths; shadow rays count
  double mean_ratio = 0;  // of the two images' mean radiance: 1 but for noise, else they do not do the same work
  double ratio() const { return mpaths / embree_mpaths; }
};
PathsResult bench_paths(int repetitions);

/// Paths a second of a scene of make_scene, and how many its rays alone would allow: if nothing but the kernels that
/// trace took time. Their share is by timestamps, the median of the repetitions; paths are as above, of up to 8 edges.
struct RayShareResult {
  double mpaths = 0, share = 0;
  std::map<std::string, double> kernels;  // share of each, in the last repetition
  double mpaths_of_rays() const { return mpaths / share; }
};
RayShareResult bench_ray_share(const std::string& scene, int repetitions);

}  // namespace tachylite::bench
