#pragma once

// The binary BVH between pairing and flattening: every leaf holds one primitive (a triangle pair or a curved
// one).

#include <cstdint>

#include "accel/box.h"
#include "base/bulk_vector.h"

namespace tachylite {

/// An inner node has the children `first` and `first + 1`; a leaf holds primitive `first`.
struct alignas(16) BinaryNode {
  float lo[3];
  uint32_t first;
  float hi[3];
  uint32_t is_leaf;

  Box box() const {
    constexpr IntLanes xyz{-1, -1, -1, 0};
    IntLanes l, h;
    std::memcpy(&l, lo, sizeof l);
    std::memcpy(&h, hi, sizeof h);
    Box b;
    b.lo = reinterpret_cast<Lanes>(l & xyz);
    b.hi = reinterpret_cast<Lanes>(h & xyz);
    return b;
  }
  void set_box(const Box& b) {
    for (int a = 0; a < 3; ++a) lo[a] = b.lo[a], hi[a] = b.hi[a];
  }
};

/// The root is nodes[kRoot]; siblings are 2k and 2k + 1, so that both lie in one cache line.
/// n primitives make 2n nodes, nodes[0] being unused; no primitives, no nodes.
struct BinaryBvh {
  static constexpr uint32_t kRoot = 1;
  BulkVector<BinaryNode> nodes;
};

/// Binned surface area heuristic (Wald 2007, "On fast Construction of SAH-based Bounding Volume
/// Hierarchies"), down to one primitive a leaf. `primitives` are leaves in any order (consumed).
/// Deterministic for any number of threads. No path from the root has more than `max_depth` nodes, if
/// max_depth > log2(primitives) + 1.
BinaryBvh build_binary_bvh(BulkVector<BinaryNode> primitives, int bins, int max_depth);

/// Lowers the tree's total surface area by moving nodes to better places (Meister and Bittner 2018, "Parallel
/// Reinsertion for Bounding Volume Hierarchy Optimization"), until a pass gains little. Deterministic.
/// Returns the half area that was saved.
double optimise_binary_bvh(BinaryBvh& bvh, int max_passes);

/// Sum of half areas of the inner nodes and of the leaves, over the root's: expected visits of a random ray
/// that hits the root's box.
struct ExpectedVisits {
  double inner = 0, leaves = 0;
};
ExpectedVisits expected_visits(const BinaryBvh& bvh);

}  // namespace tachylite
