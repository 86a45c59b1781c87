#include "accel/flatten_bvh8.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"
#include "shared/bvh.h"

namespace tachylite {
namespace {

constexpr int kWidth = 8;
constexpr uint32_t kEmpty = 0;  // nodes[0] of a binary BVH is unused

/// A wide node before its encoding: which binary nodes lie in its slots.
struct Plan {
  uint32_t binary = kEmpty;  // the wide node's own box
  uint32_t address = 0, child_base = 0, leaf_base = 0;
  std::array<uint32_t, kWidth> slots{};
};

/// The least cost of covering a subtree by a forest of at most i trees, i = 1..7, where cost is the sum of
/// the half areas of wide nodes (leaves cost the same in any forest). Equations of Ylitie et al. 2017,
/// section 3.1.
class Collapse {
 public:
  explicit Collapse(const std::vector<BinaryNode>& nodes) : nodes_(nodes), costs_(nodes.size() / 2) {
    compute(BinaryBvh::kRoot, 0);
  }

  /// The children of the wide node that has the box of `node`; their number.
  int children(uint32_t node, std::array<uint32_t, kWidth>& out) const {
    int count = 0;
    if (nodes_[node].is_leaf)
      out[static_cast<size_t>(count++)] = node;
    else
      split(node, kWidth, out, count);
    return count;
  }

 private:
  using Costs =
      std::array<float, kWidth>;  // [i - 1]: forests of at most i trees; the last is not used by parents

  Costs costs(uint32_t node) const { return nodes_[node].is_leaf ? Costs{} : costs_[nodes_[node].first / 2]; }

  void compute(uint32_t node, int depth) {
    if (nodes_[node].is_leaf) return;
    const uint32_t first = nodes_[node].first;
    if (depth < 10) {
      parallel_invoke([&] { compute(first, depth + 1); }, [&] { compute(first + 1, depth + 1); });
    } else {
      compute(first, depth + 1);
      compute(first + 1, depth + 1);
    }
    const Costs left = costs(first), right = costs(first + 1);
    Costs& c = costs_[first / 2];
    for (size_t i = 2; i <= kWidth; ++i) {
      float best = std::numeric_limits<float>::infinity();
      for (size_t k = 1; k < i; ++k) best = std::min(best, left[k - 1] + right[i - k - 1]);
      c[i - 1] = best;
    }
    c[0] = half_area(nodes_[node].box()) + c[kWidth - 1];
    for (size_t i = 1; i < kWidth - 1; ++i) c[i] = std::min(c[i], c[i - 1]);
  }

  void forest(uint32_t node, size_t trees, std::array<uint32_t, kWidth>& out, int& count) const {
    const Costs& c = costs(node);
    while (trees > 1 && c[trees - 1] == c[trees - 2]) --trees;
    if (trees == 1 || nodes_[node].is_leaf)
      out[static_cast<size_t>(count++)] = node;
    else
      split(node, trees, out, count);
  }

  void split(uint32_t node, size_t trees, std::array<uint32_t, kWidth>& out, int& count) const {
    const uint32_t first = nodes_[node].first;
    const Costs left = costs(first), right = costs(first + 1);
    size_t best = 1;
    for (size_t k = 2; k < trees; ++k)
      if (left[k - 1] + right[trees - k - 1] < left[best - 1] + right[trees - best - 1]) best = k;
    forest(first, best, out, count);
    forest(first + 1, trees - best, out, count);
  }

  const std::vector<BinaryNode>& nodes_;
  std::vector<Costs> costs_;  // of each inner node, by its sibling pair of children
};

/// Gives the inner children the slots that lie most in their direction from the node's centre, so that
/// slot ^ octant orders them from near to far; leaves, which are all tested at once, take what is left.
std::array<uint32_t, kWidth> assign_slots(const std::vector<BinaryNode>& nodes, uint32_t node,
                                          const std::array<uint32_t, kWidth>& children, int count) {
  std::array<uint32_t, kWidth> slots{};
  const Lanes centre = centre2(nodes[node].box());
  std::array<std::array<float, kWidth>, kWidth> gain;
  int open = 0;
  std::array<uint32_t, kWidth> inner;
  for (int i = 0; i < count; ++i) {
    const auto child = children[static_cast<size_t>(i)];
    if (nodes[child].is_leaf) continue;
    const Lanes d = centre2(nodes[child].box()) - centre;
    for (size_t s = 0; s < kWidth; ++s)
      gain[static_cast<size_t>(open)][s] =
          (s & 1 ? d[0] : -d[0]) + (s & 2 ? d[1] : -d[1]) + (s & 4 ? d[2] : -d[2]);
    inner[static_cast<size_t>(open++)] = child;
  }
  for (int left = open; left > 0; --left) {
    size_t best_child = kWidth, best_slot = 0;
    for (size_t i = 0; i < static_cast<size_t>(open); ++i) {
      if (inner[i] == kEmpty) continue;
      for (size_t s = 0; s < kWidth; ++s) {
        if (slots[s] != kEmpty) continue;
        if (best_child == kWidth || gain[i][s] > gain[best_child][best_slot]) {
          best_child = i;
          best_slot = s;
        }
      }
    }
    slots[best_slot] = inner[best_child];
    inner[best_child] = kEmpty;
  }
  size_t s = 0;
  for (int i = 0; i < count; ++i) {
    const auto child = children[static_cast<size_t>(i)];
    if (!nodes[child].is_leaf) continue;
    while (slots[s] != kEmpty) ++s;
    slots[s] = child;
  }
  return slots;
}

/// Blocks of 8 node addresses. Nodes whose inner children have disjoint slots share a block, where one with
/// room is among the last blocks that were opened.
class BlockAllocator {
 public:
  uint32_t allocate(uint32_t mask) {
    for (Open& o : open_)
      if (!(o.used & mask)) {
        o.used |= mask;
        return o.block;
      }
    Open& fullest = *std::max_element(open_.begin(), open_.end(), [](const Open& a, const Open& b) {
      return std::popcount(a.used) < std::popcount(b.used);
    });
    fullest = {blocks_, mask};
    return blocks_++;
  }
  uint32_t blocks() const { return blocks_; }

 private:
  struct Open {
    uint32_t block = 0, used = 0xff;
  };
  std::array<Open, 16> open_;
  uint32_t blocks_ = 1;  // block 0 is the root's
};

/// The grid of one axis of a node: coordinates are p + q * 2^(exponent - 127), q in 0..255.
struct Grid {
  float p;
  uint32_t exponent;  // biased
  float step;

  Grid(float lo, float hi) : p(lo), exponent(1), step(0) {
    int e = 0;
    std::frexp((static_cast<double>(hi) - lo) / 255, &e);
    exponent = static_cast<uint32_t>(std::clamp(e - 1 + 127, 1, 254));
    for (;; ++exponent) {
      step = std::bit_cast<float>(exponent << 23);
      if (covers(255, hi)) break;
    }
  }
  float decode(uint32_t q) const { return p + static_cast<float>(q) * step; }
  double exact(uint32_t q) const { return static_cast<double>(p) + static_cast<double>(q) * step; }
  bool covers(uint32_t q, float hi) const { return decode(q) >= hi && exact(q) >= hi; }

  uint32_t lower(float x) const {
    auto q = static_cast<uint32_t>(std::min(255.0, std::floor((static_cast<double>(x) - p) / step)));
    while (q > 0 && (decode(q) > x || exact(q) > x)) --q;
    return q;
  }
  uint32_t upper(float x) const {
    auto q = static_cast<uint32_t>(std::min(255.0, std::ceil((static_cast<double>(x) - p) / step)));
    while (!covers(q, x)) ++q;
    return q;
  }
};

class Flattener {
 public:
  Flattener(const BinaryBvh& bvh, std::span<const uint8_t> is_curved)
      : nodes_(bvh.nodes), is_curved_(is_curved) {}

  FlatNodes run() {
    plan();
    constexpr uint32_t kAvailable = 1u << 24;
    if (blocks_ > kAvailable)
      throw RenderError(
          fmt::format("the BVH needs {} blocks of 8 nodes, {} can be addressed", blocks_, kAvailable));
    flat_.rows.assign(size_t{blocks_} * kWidth * gpu::kBvhNodeRows, glm::uvec4(0));
    parallel_for(0, plans_.size(), 1024, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) encode(plans_[i]);
    });
    flat_.nodes = plans_.size();
    measure();
    return std::move(flat_);
  }

 private:
  /// Depth first, so that subtrees lie together in memory.
  void plan() {
    const Collapse collapse(nodes_);
    BlockAllocator allocator;
    struct Entry {
      uint32_t binary, address;
      int depth;
    };
    std::vector<Entry> stack{{BinaryBvh::kRoot, 0, 1}};
    while (!stack.empty()) {
      const Entry e = stack.back();
      stack.pop_back();
      std::array<uint32_t, kWidth> children;
      const int count = collapse.children(e.binary, children);
      Plan p;
      p.binary = e.binary;
      p.address = e.address;
      p.leaf_base = static_cast<uint32_t>(flat_.leaf_primitives.size());
      p.slots = assign_slots(nodes_, e.binary, children, count);
      uint32_t inner = 0;
      for (size_t s = 0; s < kWidth; ++s) {
        if (p.slots[s] == kEmpty) continue;
        if (nodes_[p.slots[s]].is_leaf)
          flat_.leaf_primitives.push_back(nodes_[p.slots[s]].first);
        else
          inner |= 1u << s;
      }
      if (inner) p.child_base = allocator.allocate(inner);
      for (uint32_t s = kWidth; s-- > 0;)
        if (inner >> s & 1) stack.push_back({p.slots[s], p.child_base * kWidth + s, e.depth + 1});
      flat_.depth = std::max(flat_.depth, e.depth);
      flat_.children += static_cast<uint64_t>(count);
      plans_.push_back(p);
    }
    blocks_ = allocator.blocks();
  }

  void encode(const Plan& p) {
    const Box box = nodes_[p.binary].box();
    const std::array<Grid, 3> grid{Grid(box.lo[0], box.hi[0]), Grid(box.lo[1], box.hi[1]),
                                   Grid(box.lo[2], box.hi[2])};
    uint32_t inner = 0, leaf = 0, curved = 0;
    std::array<std::array<uint32_t, 2>, 3> lo, hi;  // [axis][slots 0-3, 4-7]
    for (auto& words : lo) words = {0xffffffffu, 0xffffffffu};
    for (auto& words : hi) words = {0, 0};
    for (uint32_t s = 0; s < kWidth; ++s) {
      if (p.slots[s] == kEmpty) continue;
      const BinaryNode& child = nodes_[p.slots[s]];
      (child.is_leaf ? leaf : inner) |= 1u << s;
      if (child.is_leaf && is_curved_[child.first]) curved |= 1u << s;
      const uint32_t shift = 8 * (s & 3);
      for (size_t a = 0; a < 3; ++a) {
        lo[a][s / 4] ^= (0xffu ^ grid[a].lower(child.lo[a])) << shift;
        hi[a][s / 4] |= grid[a].upper(child.hi[a]) << shift;
      }
    }
    glm::uvec4* row = &flat_.rows[size_t{p.address} * gpu::kBvhNodeRows];
    row[0] = {std::bit_cast<uint32_t>(grid[0].p), std::bit_cast<uint32_t>(grid[1].p),
              std::bit_cast<uint32_t>(grid[2].p),
              grid[0].exponent | grid[1].exponent << 8 | grid[2].exponent << 16 | inner << 24};
    row[1] = {p.child_base, p.leaf_base, curved, leaf};
    row[2] = {lo[0][0], lo[0][1], lo[1][0], lo[1][1]};
    row[3] = {lo[2][0], lo[2][1], hi[0][0], hi[0][1]};
    row[4] = {hi[1][0], hi[1][1], hi[2][0], hi[2][1]};
  }

  /// Expected visits from the areas of the boxes as they were quantised.
  void measure() {
    for (const Plan& p : plans_) {
      const Box box = nodes_[p.binary].box();
      const std::array<Grid, 3> grid{Grid(box.lo[0], box.hi[0]), Grid(box.lo[1], box.hi[1]),
                                     Grid(box.lo[2], box.hi[2])};
      for (uint32_t child : p.slots) {
        if (child == kEmpty) continue;
        const BinaryNode& c = nodes_[child];
        Box quantised;
        for (size_t a = 0; a < 3; ++a) {
          quantised.lo[static_cast<int>(a)] = grid[a].decode(grid[a].lower(c.lo[a]));
          quantised.hi[static_cast<int>(a)] = grid[a].decode(grid[a].upper(c.hi[a]));
        }
        (c.is_leaf ? flat_.leaf_visits : flat_.node_visits) += half_area(quantised);
      }
    }
    const double root = half_area(nodes_[BinaryBvh::kRoot].box());
    flat_.node_visits = 1 + flat_.node_visits / root;
    flat_.leaf_visits /= root;
  }

  const std::vector<BinaryNode>& nodes_;
  std::span<const uint8_t> is_curved_;
  std::vector<Plan> plans_;
  uint32_t blocks_ = 0;
  FlatNodes flat_;
};

/// A root whose slots are all empty.
FlatNodes empty_root() {
  FlatNodes flat;
  flat.rows.assign(size_t{kWidth} * gpu::kBvhNodeRows, glm::uvec4(0));
  flat.rows[0].w = 1u | 1u << 8 | 1u << 16;
  flat.rows[2] = glm::uvec4(0xffffffffu);
  flat.rows[3] = {0xffffffffu, 0xffffffffu, 0, 0};
  flat.nodes = 1;
  flat.depth = 1;
  return flat;
}

}  // namespace

FlatNodes flatten_bvh8(const BinaryBvh& bvh, std::span<const uint8_t> is_curved) {
  return bvh.nodes.empty() ? empty_root() : Flattener(bvh, is_curved).run();
}

}  // namespace tachylite
