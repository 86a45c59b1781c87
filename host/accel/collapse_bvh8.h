#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "accel/binary_bvh.h"

namespace tachylite {

constexpr uint32_t kBvhWidth = 8;
constexpr uint32_t kEmptySlot = 0;  // nodes[0] of a binary BVH is unused
/// Binary nodes that become the children of one wide node, in no order; the rest is kEmptySlot.
using WideChildren = std::array<uint32_t, kBvhWidth>;

/// Which binary nodes become wide nodes, such that the sum of their surface areas is least: the dynamic
/// programme of Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
/// Wide BVHs", section 3.1. Leaves hold one primitive each, so they cost the same however they are gathered.
class Bvh8Collapse {
 public:
  /// `nodes` must outlive this and hold a tree.
  explicit Bvh8Collapse(std::span<const BinaryNode> nodes);

  /// The children of the wide node that takes the place of `node` (which may be a leaf: then it is the only
  /// child).
  WideChildren children(uint32_t node) const;

  /// Number of leaves below `node`.
  uint32_t leaves(uint32_t node) const {
    return nodes_[node].is_leaf ? 1 : subtrees_[nodes_[node].first / 2].leaves;
  }

 private:
  /// costs[i - 1]: least sum of half areas of wide nodes, if the subtree becomes a forest of at most i trees.
  using Costs = std::array<float, kBvhWidth - 1>;
  struct Subtree {
    Costs costs;
    uint32_t leaves;
  };

  Costs costs(uint32_t node) const {
    return nodes_[node].is_leaf ? Costs{} : subtrees_[nodes_[node].first / 2].costs;
  }
  void solve(uint32_t node, int depth);
  void forest(uint32_t node, uint32_t trees, WideChildren& out, uint32_t& count) const;
  void split(uint32_t node, uint32_t trees, WideChildren& out, uint32_t& count) const;

  const std::span<const BinaryNode> nodes_;
  BulkVector<Subtree> subtrees_;  // of each inner node, by its sibling pair of children
};

}  // namespace tachylite
