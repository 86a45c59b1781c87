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
  Builder(std::vector<BinaryNode>& primitives, int bins, int max_depth)
      : primitives_(primitives),
        bins_(std::min(bins, kMaxBins)),
        max_depth_(max_depth),
        nodes_(2 * primitives.size()) {}

  std::vector<BinaryNode> run() {
    build(BinaryBvh::kRoot, 0, primitives_.size(), range_centres(0, primitives_.size()), 1);
    return std::move(nodes_);
  }

 private:
  Box range_box(size_t begin, size_t end) const {
    Box b;
    for (size_t i = begin; i < end; ++i) b.grow(primitives_[i].box());
    return b;
  }
  Box range_centres(size_t begin, size_t end) const {
    Box b;
    for (size_t i = begin; i < end; ++i) b.grow(centre2(primitives_[i].box()));
    return b;
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
    if (n == 2) {
      left_centres.grow(centre2(primitives_[begin].box()));
      right_centres.grow(centre2(primitives_[begin + 1].box()));
      return middle;
    }
    const bool deep = depth + static_cast<int>(std::bit_width(n - 1)) >= max_depth_;
    const int bins = std::min<int>(bins_, static_cast<int>(4 + std::min<size_t>(n, 1 << 16) / 16));
    const BinMapping mapping(centres, bins);
    Split split;
    if (!deep) split = find_split(begin, end, mapping);
    if (split.axis >= 0) {
      const auto is_left = [&](const BinaryNode& p) {
        return mapping(centre2(p.box()))[split.axis] < split.bin;
      };
      size_t i = begin, j = end;
      for (;;) {
        for (; i < j; ++i) {
          if (!is_left(primitives_[i])) break;
          left_centres.grow(centre2(primitives_[i].box()));
        }
        for (; i < j; --j) {
          if (is_left(primitives_[j - 1])) break;
          right_centres.grow(centre2(primitives_[j - 1].box()));
        }
        if (i == j) break;
        std::swap(primitives_[i], primitives_[j - 1]);
      }
      middle = i;
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

  std::vector<BinaryNode>& primitives_;
  const int bins_, max_depth_;
  std::vector<BinaryNode> nodes_;
};

}  // namespace

BinaryBvh build_binary_bvh(std::vector<BinaryNode> primitives, int bins, int max_depth) {
  BinaryBvh bvh;
  if (primitives.empty()) return bvh;
  bvh.nodes = Builder(primitives, bins, max_depth).run();
  return bvh;
}

ExpectedVisits expected_visits(const BinaryBvh& bvh) {
  ExpectedVisits sum;
  if (bvh.nodes.empty()) return sum;
  for (size_t i = BinaryBvh::kRoot; i < bvh.nodes.size(); ++i)
    (bvh.nodes[i].is_leaf ? sum.leaves : sum.inner) += half_area(bvh.nodes[i].box());
  const double root = half_area(bvh.nodes[BinaryBvh::kRoot].box());
  return {sum.inner / root, sum.leaves / root};
}

}  // namespace tachylite
