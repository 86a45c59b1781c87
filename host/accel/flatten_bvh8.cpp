#include "accel/flatten_bvh8.h"

#include <algorithm>
#include <bit>

#include "accel/assign_slots.h"
#include "accel/collapse_bvh8.h"
#include "accel/encode_node.h"
#include "base/error.h"
#include "base/parallel.h"
#include "shared/bvh.h"

namespace tachylite {
namespace {

/// Blocks of 8 node addresses. Nodes whose inner children have disjoint slots share a block, if one with room
/// is among the last that were opened.
class BlockAllocator {
 public:
  explicit BlockAllocator(uint32_t first) : blocks_(first) {}

  uint32_t allocate(uint32_t slots) {
    for (Open& o : open_)
      if (!(o.used & slots)) {
        o.used |= slots;
        return o.block;
      }
    Open& fullest = *std::max_element(open_.begin(), open_.end(), [](const Open& a, const Open& b) {
      return std::popcount(a.used) < std::popcount(b.used);
    });
    fullest = {blocks_, slots};
    return blocks_++;
  }
  uint32_t blocks() const { return blocks_; }

 private:
  struct Open {
    uint32_t block = 0, used = 0xff;
  };
  std::array<Open, 16> open_;
  uint32_t blocks_;
};

/// The wide nodes of one subtree, depth first, so that they lie together in memory. Blocks and leaves are
/// numbered from 0 within the part until all parts are known.
struct Part {
  uint32_t root = BinaryBvh::kRoot;  // binary node
  uint32_t root_address = 0;         // in the whole
  int depth = 1;                     // of the root; then of the deepest node
  uint32_t blocks = 0, first_block = 0, first_leaf = 0;
  std::vector<WideNode> nodes;
  std::vector<uint32_t> leaf_primitives;
  uint64_t children = 0;
  double inner_area = 0, leaf_area = 0;
};

class Flattener {
 public:
  Flattener(std::span<const BinaryNode> nodes, const CurvedLeaves& curved)
      : nodes_(nodes), curved_(curved), collapse_(nodes) {}

  FlatNodes run() {
    plan_parts();
    place_parts();
    parallel_for(0, parts_.size(), 1, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) encode(parts_[i]);
    });
    const double root = half_area(nodes_[BinaryBvh::kRoot].box());
    flat_.node_visits = 1;
    for (const Part& p : parts_) {
      flat_.nodes += p.nodes.size();
      flat_.children += p.children;
      flat_.depth = std::max(flat_.depth, p.depth);
      flat_.node_visits += p.inner_area / root;
      flat_.leaf_visits += p.leaf_area / root;
    }
    return std::move(flat_);
  }

 private:
  static constexpr uint32_t kPartLeaves = 1 << 13;

  /// The top of the tree becomes parts_[0], and each of its subtrees of at most kPartLeaves leaves another
  /// part.
  void plan_parts() {
    parts_.resize(1);
    BlockAllocator allocator(1);  // block 0 is the root's
    std::vector<Part> subtrees;
    plan(parts_[0], allocator, &subtrees);
    std::move(subtrees.begin(), subtrees.end(), std::back_inserter(parts_));
    parallel_for(1, parts_.size(), 1, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) {
        BlockAllocator own(0);
        plan(parts_[i], own, nullptr);
      }
    });
  }

  void plan(Part& part, BlockAllocator& allocator, std::vector<Part>* subtrees) const {
    struct Entry {
      uint32_t binary, address;
      int depth;
    };
    part.leaf_primitives.reserve(collapse_.leaves(part.root));
    part.nodes.reserve(collapse_.leaves(part.root) / 4);  // most have five children or more
    std::vector<Entry> stack{{part.root, part.root_address, part.depth}};
    while (!stack.empty()) {
      const Entry e = stack.back();
      stack.pop_back();
      WideNode wide;
      wide.binary = e.binary;
      wide.address = e.address;
      wide.leaf_base = static_cast<uint32_t>(part.leaf_primitives.size());
      wide.slots = assign_slots(nodes_, collapse_.children(e.binary));
      uint32_t inner = 0;
      for (uint32_t s = 0; s < kBvhWidth; ++s) {
        if (wide.slots[s] == kEmptySlot) continue;
        ++part.children;
        if (nodes_[wide.slots[s]].is_leaf)
          part.leaf_primitives.push_back(nodes_[wide.slots[s]].first);
        else
          inner |= 1u << s;
      }
      if (inner) wide.child_base = allocator.allocate(inner);
      part.depth = std::max(part.depth, e.depth);
      part.nodes.push_back(wide);
      for (uint32_t s = kBvhWidth; s-- > 0;) {
        if (!(inner >> s & 1)) continue;
        const Entry child{wide.slots[s], wide.child_base * kBvhWidth + s, e.depth + 1};
        if (subtrees && collapse_.leaves(child.binary) <= kPartLeaves) {
          Part& below = subtrees->emplace_back();
          below.root = child.binary;
          below.root_address = child.address;
          below.depth = child.depth;
        } else {
          stack.push_back(child);
        }
      }
    }
    part.blocks = allocator.blocks();
  }

  void place_parts() {
    uint32_t blocks = 0, leaves = 0;
    for (Part& p : parts_) {
      p.first_block = blocks;
      p.first_leaf = leaves;
      blocks += p.blocks;
      leaves += static_cast<uint32_t>(p.leaf_primitives.size());
    }
    constexpr uint32_t kAvailable = 1u << 24;
    if (blocks > kAvailable)
      throw RenderError(
          fmt::format("the BVH needs {} blocks of 8 nodes, {} can be addressed", blocks, kAvailable));
    flat_.rows.resize(size_t{blocks} * kBvhWidth * gpu::kBvhNodeRows);
    parallel_fill<glm::uvec4>(flat_.rows, glm::uvec4(0));
    flat_.leaf_primitives.resize(leaves);
  }

  void encode(Part& part) {
    std::copy(part.leaf_primitives.begin(), part.leaf_primitives.end(),
              flat_.leaf_primitives.begin() + part.first_leaf);
    constexpr size_t kAhead = 3;
    for (size_t i = 0; i < part.nodes.size(); ++i) {
      if (i + kAhead < part.nodes.size())
        for (const uint32_t slot : part.nodes[i + kAhead].slots) __builtin_prefetch(&nodes_[slot]);
      WideNode& wide = part.nodes[i];
      wide.child_base += part.first_block;
      wide.leaf_base += part.first_leaf;
      if (wide.binary != part.root) wide.address += part.first_block * kBvhWidth;
      const ChildAreas areas =
          encode_node(nodes_, wide, curved_, &flat_.rows[size_t{wide.address} * gpu::kBvhNodeRows]);
      part.inner_area += areas.inner;
      part.leaf_area += areas.leaves;
    }
  }

  const std::span<const BinaryNode> nodes_;
  const CurvedLeaves& curved_;
  const Bvh8Collapse collapse_;
  std::vector<Part> parts_;
  FlatNodes flat_;
};

/// A root whose slots are all empty.
FlatNodes empty_root() {
  FlatNodes flat;
  flat.rows.assign(size_t{kBvhWidth} * gpu::kBvhNodeRows, glm::uvec4(0));
  flat.rows[0].w = 1u | 1u << 8 | 1u << 16;
  flat.rows[2] = glm::uvec4(0xffffffffu);
  flat.rows[3] = {0xffffffffu, 0xffffffffu, 0, 0};
  flat.nodes = 1;
  flat.depth = 1;
  return flat;
}

}  // namespace

FlatNodes flatten_bvh8(const BinaryBvh& bvh, const CurvedLeaves& curved) {
  return bvh.nodes.empty() ? empty_root() : Flattener(bvh.nodes, curved).run();
}

}  // namespace tachylite
