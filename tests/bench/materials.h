#pragma once

#include <string>
#include <vector>

namespace tachylite::bench {

/// What it costs to shade a vertex. Scene: a wall that fills the view, under a constant sky, paths of two edges in
/// stages; every path has one vertex on the wall, at which the sky is sampled, the bsdf is sampled and evaluated, and a
/// shadow ray and the next ray are queued. Device time by timestamp queries, least of the repetitions.
struct MaterialResult {
  std::string name;
  double shade_ns = 0;  // of the kernel shade_surface<...>, per vertex
  double total_ns = 0;  // of all kernels, per path
};
struct MaterialsResult {
  std::vector<MaterialResult> single;
  /// The wall as 64 tiles of eight of the materials, side by side.
  MaterialResult mixed;
  double mean_of_its_parts_ns = 0;  // total_ns of the same eight as 64 tiles of one material each, mean
};
MaterialsResult bench_materials(int repetitions);

}  // namespace tachylite::bench
