#pragma once

// Building the ray tracing structure: primitives -> pairs -> binary BVH -> optimised -> 8-wide compressed nodes.
// Takes arrays of the caller and knows nothing of scenes.

#include <cstdint>
#include <span>
#include <string>

#include <glm/glm.hpp>

#include "base/bulk_vector.h"
#include "shared/bvh.h"

namespace tachylite {

/// A primitive that is not a triangle; its kind is kLeafSphere, kLeafDisk or kLeafCylinder of shared/bvh.h.
struct CurvedPrimitive {
  uint32_t kind = gpu::kLeafSphere;
  glm::dmat4 object_to_world{1};  // of the unit shape; affine, invertible
};

/// What is to be traced. Vertices are in the space of the device (recentred, rounded to float): the builder keeps
/// them bit for bit. Primitive numbers: triangle i is i, curved primitive j is triangles.size() + j.
struct BvhInput {
  std::span<const glm::vec3> vertices;
  std::span<const glm::uvec3> triangles;  // vertex indices; degenerate ones (area 0 in double) are left out
  std::span<const CurvedPrimitive> curved;
  /// Only triangles of equal group are paired (empty: all may be). A rectangle's two triangles share an edge and
  /// are given adjacent, so that they become one pair.
  std::span<const uint32_t> groups;
};

struct BvhSettings {
  int bins = 32;
  double traversal_cost = 1.2, intersection_cost = 1.0;  // of the surface area heuristic
  int reinsertion_passes = 12;                           // at most (Meister and Bittner 2018); 0: none
  uint32_t most_walls = 0;                               // accel/choose_walls.h
};

struct BvhStatistics {
  uint64_t triangles = 0, dropped = 0;  // dropped: degenerate
  uint64_t leaves = 0, pairs = 0, curved = 0, walls = 0, nodes2 = 0, nodes8 = 0;
  // Expected cost of a random line that hits the scene's box, before and after the collapse (boxes as quantised), and
  // how many 8-wide nodes and leaves it meets.
  double sah_cost2 = 0, sah_cost8 = 0;
  double node_visits8 = 0, leaf_visits8 = 0;
  int depth8 = 0;
  double children_per_node = 0;
  uint64_t node_bytes = 0, leaf_bytes = 0;
  double pair_seconds = 0, build_seconds = 0, optimise_seconds = 0, flatten_seconds = 0;
};

/// A leaf in the layout of shared/bvh.h.
struct BvhLeaf {
  glm::vec4 rows[3];
  glm::uvec4 info;
};
static_assert(sizeof(BvhLeaf) == gpu::kBvhLeafRows * sizeof(glm::vec4));

/// The flattened structure in the layout of shared/bvh.h. nodes[0..4] is the root (alone in its block of 8).
/// An empty input gives a root whose slots are all empty. Leaves from first_wall on are in no node.
struct Bvh8 {
  BulkVector<glm::uvec4> nodes;       // kBvhNodeRows a node
  BulkVector<BvhLeaf> leaves;
  uint32_t first_wall = 0;            // leaf; leaves.size() where there are none
  glm::vec3 box_min{0}, box_max{0};
  BvhStatistics statistics;
};

/// Deterministic: the same input gives the same bytes for any number of threads.
/// Throws InputError on coordinates that are not finite or beyond 1e18 and on singular transforms, RenderError when
/// there are more nodes than can be addressed.
Bvh8 build_bvh8(const BvhInput& input, const BvhSettings& settings = {});

/// The figures of `statistics`, a line each, for `tachylite info`.
std::string describe(const BvhStatistics& statistics);

}  // namespace tachylite
