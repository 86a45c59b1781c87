#pragma once

#include <span>

#include "accel/collapse_bvh8.h"

namespace tachylite {

/// Puts the children of a wide node into its slots. The traversal visits inner children in descending order
/// of slot ^ 7 ^ (sign bits of the ray's direction), so two children are ordered by the sign of the direction
/// along one axis: that of the highest bit in which their slots differ. Of all assignments this is the one
/// with the greatest expected number of pairs in the right order, pairs counting by how likely a ray meets
/// both. Leaves take what slots are left: those that a ray hits are all tested at once.
WideChildren assign_slots(std::span<const BinaryNode> nodes, const WideChildren& children);

}  // namespace tachylite
