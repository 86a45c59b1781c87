#pragma once

namespace tachylite::bench {

/// Paths a second of the Cornell box of scenes/cornell-box (512 x 512, paths of up to 8 edges, no roulette, next-event
/// estimation and BSDF sampling with MIS): the renderer against a plain path tracer with Embree's single-ray queries on
/// 2 threads. Both run in turn; each figure is that of the repetition with least CPU time, as 2 * paths / CPU seconds.
struct PathsResult {
  double mpaths = 0, embree_mpaths = 0;
  double mean_ratio = 0;  // of the two images' mean radiance: 1 but for noise, else they do not do the same work
  double ratio() const { return mpaths / embree_mpaths; }
};
PathsResult bench_paths(int repetitions);

}  // namespace tachylite::bench
