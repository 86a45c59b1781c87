#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "accel/binary_bvh.h"

namespace tachylite {

/// Nodes in the layout of shared/bvh.h, and the primitives of the binary BVH's leaves in the order of its
/// leaves.
struct FlatNodes {
  std::vector<glm::uvec4> rows;
  std::vector<uint32_t> leaf_primitives;
  uint64_t nodes = 0, children = 0;
  int depth = 0;
  double node_visits = 0,
         leaf_visits = 0;  // expected, of a random ray that hits the root's box; quantised boxes
};

/// Collapses to 8-wide nodes of least total surface area (Ylitie, Karras and Laine 2017, section 3.1, with
/// leaves of one primitive). is_curved(primitive) says which leaves go into curved_mask. Throws RenderError
/// if there are more nodes than child_base can address.
FlatNodes flatten_bvh8(const BinaryBvh& bvh, std::span<const uint8_t> is_curved);

}  // namespace tachylite
