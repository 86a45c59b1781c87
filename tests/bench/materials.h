#pragma once

#include <string>
#include <vector>

namespace tachylite::bench {

/// What it costs to shade a vertex. Scene: a wall that fills the view, under a constant sky, paths of two edges in
/// stages; every path has one vertex on the wall, at which the sky is sampled, the bsdf is sampled and evaluated, and a
/// shadow ray and the next ray are queued. CPU time of all threads, which on a CPU driver is the device's: the least of
/// the repetitions, which go round all scenes in turn.
struct MaterialResult {
  std::string name;
  double total_ns = 0;  // of everything, per path
  double shade_ns = 0;  // of the kernels shade_surface<...>, per vertex: their share of the time by timestamps (median)
};
struct MaterialsResult {
  std::vector<MaterialResult> single;
  /// The wall as 64 tiles of eight of the materials, side by side.
  MaterialResult mixed;
  MaterialResult parts;  // the mean of the same eight as 64 tiles of one material each
};
MaterialsResult bench_materials(int repetitions);

}  // namespace tachylite::bench
