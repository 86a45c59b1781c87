#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>

#include "accel/binary_bvh.h"
#include "base/check.h"
#include "base/parallel.h"

namespace tachylite {
namespace {

constexpr int kMaxBins = 64;
constexpr size_t kExactRange = 4;         // ranges of at most as many are divided in the best of all ways
constexpr size_t kParallelRange = 1 << 12;  // ranges of fewer primitives are built by one thread

struct Split {
  double cost = std::numeric_limits<double>::infinity();  // area times primitives, of both sides
  int axis = -1;
  int bin = 0;  // first bin of the right side
};

/// Maps the centres of a range to bins on all axes at once. Axes without extent have all centres in bin 0.
struct BinMapping {
  Lanes origin, scale;
  int bins;

  BinMapping(const Box& centres, int bin_count) : origin(centres.lo), scale{}, bins(bin_count) {
    for (int a = 0; a < 3; ++a) {
      const float extent = centres.hi[a] - centres.lo[a];
      if (extent > 1e-30f) scale[a] = static_cast<float>(bins) * 0.99999f / extent;
    }
  }
  IntLanes operator()(Lanes centre) const {
    const IntLanes i = __builtin_convertvector((centre - origin) * scale, IntLanes);
    const IntLanes top = {bins - 1, bins - 1, bins - 1, 0};
    return i < top ? i : top;
  }
};

struct Bin {
  Box box;
  uint32_t count = 0;
};

class Builder {
 public:
  Builder(BulkVector<BinaryNode>& primitives, int bins, int max_depth)
      : primitives_(primitives),
        bins_(std::min(bins, kMaxBins)),
        max_depth_(max_depth),
        nodes_(2 * primitives.size()) {}

  BulkVector<BinaryNode> run() {
    build(BinaryBvh::kRoot, 0, primitives_.size(), range_centres(0, primitives_.size()), 1);
    return std::move(nodes_);
  }

 private:
  Box range_centres(size_t begin, size_t end) const {
    return parallel_reduce<Box>(
        begin, end,
        [&](size_t first, size_t last) {
          Box b;
          for (size_t i = first; i < last; ++i) b.grow(centre2(primitives_[i].box()));
          return b;
        },
        merge);
  }

  /// The subtree over primitives [begin, end); its inner nodes' children are the sibling pairs begin + 1,
  /// ..., end - 1, so that no thread asks another for room.
  void build(uint32_t node, size_t begin, size_t end, const Box& centres, int depth) {
    const size_t n = end - begin;
    if (n == 1) {
      nodes_[node] = primitives_[begin];
      return;
    }
    Box left_centres, right_centres;
    const size_t middle = divide(begin, end, centres, depth, left_centres, right_centres);
    // Pairs of the left side: begin + 1 .. middle - 1; of the right: middle + 1 .. end - 1; `middle` is this
    // node's.
    const auto first = static_cast<uint32_t>(2 * middle);
    const auto left = [&] { build(first, begin, middle, left_centres, depth + 1); };
    const auto right = [&] { build(first + 1, middle, end, right_centres, depth + 1); };
    if (n > kParallelRange) {
      parallel_invoke(left, right);
    } else {
      left();
      right();
    }
    BinaryNode& parent = nodes_[node];
    parent.set_box(merge(nodes_[first].box(), nodes_[first + 1].box()));
    parent.first = first;
    parent.is_leaf = 0;
  }

  size_t divide(size_t begin, size_t end, const Box& centres, int depth, Box& left_centres,
                Box& right_centres) {
    const size_t n = end - begin;
    size_t middle = begin + n / 2;
    const bool deep = depth + static_cast<int>(std::bit_width(n - 1)) >= max_depth_;
    if (n <= kExactRange && !deep) return divide_exactly(begin, n);
    const int bins = std::min<int>(bins_, static_cast<int>(4 + std::min<size_t>(n, 1 << 16) / 16));
    const BinMapping mapping(centres, bins);
    Split split;
    if (!deep) split = find_split(begin, end, mapping);
    if (split.axis >= 0) {
      middle = partition(begin, end, mapping, split, left_centres, right_centres);
    } else {
      // All centres coincide, or the tree must not grow deeper: halves along the longest axis.
      const Lanes d = centres.hi - centres.lo;
      const int axis = d[0] >= d[1] && d[0] >= d[2] ? 0 : d[1] >= d[2] ? 1 : 2;
      const auto range = primitives_.begin();
      std::nth_element(range + static_cast<ptrdiff_t>(begin), range + static_cast<ptrdiff_t>(middle),
                       range + static_cast<ptrdiff_t>(end), [axis](const BinaryNode& a, const BinaryNode& b) {
                         const float x = a.lo[axis] + a.hi[axis], y = b.lo[axis] + b.hi[axis];
                         return x < y || (x == y && a.first < b.first);
                       });
      left_centres = range_centres(begin, middle);
      right_centres = range_centres(middle, end);
    }
    return middle;
  }

  /// Without branches (Lomuto's scheme), as no processor foresees which side a primitive goes to.
  size_t partition(size_t begin, size_t end, const BinMapping& mapping, const Split& split, Box& left_centres,
                   Box& right_centres) {
    const int axis = split.axis;
    const float origin = mapping.origin[axis], scale = mapping.scale[axis];
    const Box none;
    Box left, right;
    size_t middle = begin;
    for (size_t i = begin; i < end; ++i) {
      const BinaryNode p = primitives_[i];
      const int is_left = static_cast<int>((p.lo[axis] + p.hi[axis] - origin) * scale) < split.bin;
      primitives_[i] = primitives_[middle];
      primitives_[middle] = p;
      middle += static_cast<size_t>(is_left);
      const Lanes centre = centre2(p.box());
      const IntLanes goes_left = IntLanes{} - is_left;
      left.lo = min(left.lo, goes_left ? centre : none.lo);
      left.hi = max(left.hi, goes_left ? centre : none.hi);
      right.lo = min(right.lo, goes_left ? none.lo : centre);
      right.hi = max(right.hi, goes_left ? none.hi : centre);
    }
    left_centres = left;
    right_centres = right;
    return middle;
  }

  /// Of 2 to kExactRange primitives; they need no centres. Puts the left side first and returns where the right begins.
  size_t divide_exactly(size_t begin, size_t n) {
    if (n == 2) return begin + 1;
    std::array<Box, 1 << kExactRange> boxes;  // of each set of primitives
    std::array<uint32_t, 1 << kExactRange> sizes;
    sizes[0] = 0;
    const uint32_t all = (1u << n) - 1;
    for (uint32_t set = 1; set <= all; ++set) {
      const uint32_t others = set & (set - 1);
      boxes[set] = merge(boxes[others], primitives_[begin + static_cast<size_t>(std::countr_zero(set))].box());
      sizes[set] = sizes[others] + 1;
    }
    float best = std::numeric_limits<float>::infinity();
    uint32_t left = 1;
    for (uint32_t set = 1; set < all; set += 2) {  // the first is on the left
      const float cost = half_area(boxes[set]) * static_cast<float>(sizes[set] - 1) +
                         half_area(boxes[all ^ set]) * static_cast<float>(n - sizes[set] - 1);
      if (cost < best) {
        best = cost;
        left = set;
      }
    }
    const auto range = primitives_.begin() + static_cast<ptrdiff_t>(begin);
    std::array<BinaryNode, kExactRange> copy;
    std::copy_n(range, n, copy.begin());
    size_t low = 0, high = sizes[left];
    for (size_t i = 0; i < n; ++i) range[static_cast<ptrdiff_t>(left >> i & 1 ? low++ : high++)] = copy[i];
    return begin + sizes[left];
  }

  Split find_split(size_t begin, size_t end, const BinMapping& mapping) const {
    std::array<std::array<Bin, kMaxBins>, 3> bins;
    const auto used = static_cast<size_t>(mapping.bins);
    for (auto& axis : bins) std::fill_n(axis.begin(), used, Bin{});
    for (size_t i = begin; i < end; ++i) {
      const Box box = primitives_[i].box();
      const IntLanes at = mapping(centre2(box));
      for (size_t a = 0; a < 3; ++a) {
        Bin& bin = bins[a][static_cast<size_t>(at[a])];
        bin.box.grow(box);
        ++bin.count;
      }
    }
    Split best;
    for (size_t a = 0; a < 3; ++a) {
      if (mapping.scale[a] == 0) continue;
      std::array<double, kMaxBins> right_cost;
      Box right;
      uint32_t right_count = 0;
      for (size_t b = used; b-- > 1;) {
        right.grow(bins[a][b].box);
        right_count += bins[a][b].count;
        right_cost[b] = right_count ? static_cast<double>(half_area(right)) * right_count : -1;
      }
      Box left;
      uint32_t left_count = 0;
      for (size_t b = 1; b < used; ++b) {
        left.grow(bins[a][b - 1].box);
        left_count += bins[a][b - 1].count;
        if (!left_count || right_cost[b] < 0) continue;
        const double cost = static_cast<double>(half_area(left)) * left_count + right_cost[b];
        if (cost < best.cost) best = {cost, static_cast<int>(a), static_cast<int>(b)};
      }
    }
    return best;
  }

  BulkVector<BinaryNode>& primitives_;
  const int bins_, max_depth_;
  BulkVector<BinaryNode> nodes_;
};

}  // namespace

BinaryBvh build_binary_bvh(BulkVector<BinaryNode> primitives, int bins, int max_depth) {
  BinaryBvh bvh;
  if (primitives.empty()) return bvh;
  bvh.nodes = Builder(primitives, bins, max_depth).run();
  return bvh;
}

ExpectedVisits expected_visits(const BinaryBvh& bvh) {
  if (bvh.nodes.empty()) return {};
  const ExpectedVisits sum = parallel_reduce<ExpectedVisits>(
      BinaryBvh::kRoot, bvh.nodes.size(),
      [&](size_t first, size_t last) {
        ExpectedVisits part;
        for (size_t i = first; i < last; ++i)
          (bvh.nodes[i].is_leaf ? part.leaves : part.inner) += half_area(bvh.nodes[i].box());
        return part;
      },
      [](const ExpectedVisits& a, const ExpectedVisits& b) {
        return ExpectedVisits{a.inner + b.inner, a.leaves + b.leaves};
      });
  const double root = half_area(bvh.nodes[BinaryBvh::kRoot].box());
  return {sum.inner / root, sum.leaves / root};
}

}  // namespace tachylite
