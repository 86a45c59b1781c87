#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tachylite::bench {

struct BuildSeconds {
  double cpu = 0, wall = 0;
};

/// What it takes to build the ray tracing structure of a mesh that is in memory: all of build_bvh8 (pairing, binary
/// tree, reinsertion, flattening), and rtcCommitScene in both qualities, on the same mesh in turn. Each figure is that
/// of the repetition with least CPU time.
struct BuildResult {
  std::string mesh;
  uint64_t triangles = 0;
  BuildSeconds ours, medium, high;
  double pair = 0, tree = 0, optimise = 0, flatten = 0;  // wall seconds of our stages, least of each
  double sah_cost = 0;                                   // of our 8-wide tree
};

/// Meshes: those of bench/scenes.h, and "soup", a million triangles of which none share an edge.
/// `only`: one mesh; empty: all.
std::vector<BuildResult> bench_build(const std::string& only, int repetitions);
std::vector<std::string> build_mesh_names();

}  // namespace tachylite::bench
