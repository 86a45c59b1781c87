#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "accel/binary_bvh.h"
#include "accel/encode_node.h"

namespace tachylite {

/// Nodes in the layout of shared/bvh.h, and the primitives of the binary BVH's leaves in the order of its
/// leaves.
struct FlatNodes {
  BulkVector<glm::uvec4> rows;
  BulkVector<uint32_t> leaf_primitives;
  uint64_t nodes = 0, children = 0;
  int depth = 0;
  double node_visits = 0,
         leaf_visits = 0;  // expected, of a random line that hits the root's box; quantised boxes
};

/// Collapses to 8-wide nodes, orders their children and encodes them. Deterministic for any number of threads.
/// Throws RenderError if there are more nodes than can be addressed.
FlatNodes flatten_bvh8(const BinaryBvh& bvh, const CurvedLeaves& curved);

}  // namespace tachylite
