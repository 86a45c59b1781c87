#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/binary_bvh.h"
#include "accel/bvh.h"
#include "accel/pair_triangles.h"

namespace tachylite {

/// Pairs of triangles that are large parallelograms, the largest first, at most `most`: kernels test these for every ray
/// at once and without loads (shared/baked.h), in less time than a tree takes to come to them. Each meets at least 1/32
/// of the random lines that meet the box of what is left without those before it.
/// primitives: the boxes of all pairs, and after them of the curved primitives.
std::vector<uint32_t> choose_walls(const BvhInput& input, std::span<const TrianglePair> pairs,
                                   std::span<const BinaryNode> primitives, uint32_t most);

}  // namespace tachylite
