#include "pack/light_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/check.h"
#include "base/parallel.h"
#include "base/pi.h"
#include "pack/float_bits.h"
#include "shared/light.h"

namespace tachylite {
namespace {

using glm::dvec3;
constexpr int kBins = 12;
constexpr size_t kManyLights = 4096;   // more: split along the longest axis only, and in parallel
constexpr uint32_t kMaxDepth = 40;     // of the binary tree

struct Cone {
  dvec3 axis;
  double theta_o;
};

/// The smallest cone around two (Conty Estevez and Kulla 2018, algorithm 1).
Cone merge_cones(const LightBounds& a, const LightBounds& b) {
  if (b.theta_o > a.theta_o) return merge_cones(b, a);
  const double between = std::atan2(glm::length(glm::cross(a.axis, b.axis)), glm::dot(a.axis, b.axis));
  if (std::min(between + b.theta_o, kPi) <= a.theta_o) return {a.axis, a.theta_o};
  const double theta_o = 0.5 * (a.theta_o + between + b.theta_o);
  if (theta_o >= kPi) return {a.axis, kPi};
  // Turn a's axis towards b's.
  const dvec3 side = glm::cross(glm::cross(a.axis, b.axis), a.axis);
  const double length = glm::length(side), turn = theta_o - a.theta_o;
  if (length < 1e-12) return {a.axis, kPi};
  return {glm::normalize(a.axis * std::cos(turn) + side / length * std::sin(turn)), theta_o};
}

/// What a split's cost needs of a group of lights; cheap to add up.
struct Group {
  dvec3 box_min{std::numeric_limits<double>::infinity()}, box_max{-std::numeric_limits<double>::infinity()};
  dvec3 axes{0};
  double theta_o = 0, theta_e = 0, power = 0;
  size_t count = 0;

  void add(const Group& g) {
    box_min = glm::min(box_min, g.box_min);
    box_max = glm::max(box_max, g.box_max);
    axes += g.axes;
    theta_o += g.theta_o;
    theta_e = std::max(theta_e, g.theta_e);
    power += g.power;
    count += g.count;
  }
  void add(const LightBounds& b) { add(Group{b.box_min, b.box_max, b.axis, b.theta_o, b.theta_e, b.power, 1}); }

  /// Power times the solid angle in which the group shines (ibid., equation 1: weighted by the cosine beyond the cone
  /// of normals) times its surface. The cone is that of a uniform cap with the same mean axis.
  double cost() const {
    if (count == 0) return 0;
    const double n = static_cast<double>(count), spread = std::acos(std::clamp(2 * glm::length(axes) / n - 1, -1.0, 1.0));
    const double o = std::min(theta_o / n + spread, kPi), w = std::min(o + theta_e, kPi);
    const double orientation =
        2 * kPi * (1 - std::cos(o)) +
        0.5 * kPi * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o));
    const dvec3 d = box_max - box_min;
    return power * orientation * 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
  }
};

dvec3 centre_of(const LightBounds& b) { return 0.5 * (b.box_min + b.box_max); }

/// A binary tree's inner node i has the children nodes[2 i] and nodes[2 i + 1].
struct BinaryNode {
  LightBounds bounds;
  bool leaf = true;
  size_t index = 0;  // of the light, or of the inner node
};

class BinaryBuilder {
 public:
  /// halve: split at the median everywhere, which is no deeper than need be.
  BinaryBuilder(std::span<const LightBounds> lights, bool halve)
      : lights_(lights), halve_(halve), order_(lights.size()), nodes_(2 * (lights.size() - 1)) {
    std::iota(order_.begin(), order_.end(), 0u);
    root_ = split(0, lights_.size(), 0, 0);
  }
  const BinaryNode& root() const { return root_; }
  const std::vector<BinaryNode>& nodes() const { return nodes_; }

 private:
  // Lights order_[first, last) at a depth. Their inner nodes, one fewer than lights, are numbered from `number` on.
  BinaryNode split(size_t first, size_t last, uint32_t depth, size_t number) {
    if (last - first == 1) return {lights_[order_[first]], true, order_[first]};
    CHECK_LT(depth, kMaxDepth);
    const size_t middle = partition(first, last, depth);
    BinaryNode& a = nodes_[2 * number];
    BinaryNode& b = nodes_[2 * number + 1];
    const auto left = [&] { a = split(first, middle, depth + 1, number + 1); };
    const auto right = [&] { b = split(middle, last, depth + 1, number + (middle - first)); };
    if (last - first > kManyLights) {
      parallel_invoke(left, right);
    } else {
      left();
      right();
    }
    return {merge(a.bounds, b.bounds), false, number};
  }

  // Reorders and returns where the second half begins.
  size_t partition(size_t first, size_t last, uint32_t depth) {
    dvec3 lo = centre_of(lights_[order_[first]]), hi = lo;
    for (size_t i = first; i < last; ++i) {
      lo = glm::min(lo, centre_of(lights_[order_[i]]));
      hi = glm::max(hi, centre_of(lights_[order_[i]]));
    }
    const dvec3 extent = hi - lo;
    const int longest = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
    const size_t count = last - first;
    const bool must_halve = halve_ || depth + std::bit_width(count - 1) >= kMaxDepth;
    int best_axis = -1, best_bin = 0;
    double best_cost = 0;
    for (int axis = 0; axis < 3 && !must_halve && count > 2; ++axis) {
      if (extent[axis] <= 0 || (count > kManyLights && axis != longest)) continue;
      const auto [bin, value] = best_split(first, last, axis, lo[axis], extent[axis]);
      // Thin slabs are worse than their surface says: weigh by the elongation (ibid., k_r).
      const double regularised = value * extent[longest] / extent[axis];
      if (bin > 0 && (best_axis < 0 || regularised < best_cost)) {
        best_axis = axis;
        best_bin = bin;
        best_cost = regularised;
      }
    }
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = order_.begin() + static_cast<std::ptrdiff_t>(last);
    if (best_axis >= 0) {
      const auto middle = std::stable_partition(begin, end, [&](uint32_t i) {
        return bin_of(centre_of(lights_[i])[best_axis], lo[best_axis], extent[best_axis]) < best_bin;
      });
      if (middle != begin && middle != end) return static_cast<size_t>(middle - order_.begin());
    }
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [&](uint32_t a, uint32_t b) {
      const double ca = centre_of(lights_[a])[longest], cb = centre_of(lights_[b])[longest];
      return ca < cb || (ca == cb && a < b);
    });
    return static_cast<size_t>(middle - order_.begin());
  }

  static int bin_of(double x, double lo, double extent) {
    return std::clamp(static_cast<int>((x - lo) / extent * kBins), 0, kBins - 1);
  }

  // First bin of the second half, and the cost; bin 0: no split along this axis.
  std::pair<int, double> best_split(size_t first, size_t last, int axis, double lo, double extent) const {
    std::array<Group, kBins> bins;
    for (size_t i = first; i < last; ++i) {
      const LightBounds& light = lights_[order_[i]];
      bins[static_cast<size_t>(bin_of(centre_of(light)[axis], lo, extent))].add(light);
    }
    std::array<double, kBins> right_cost{};
    Group right, left;
    for (size_t b = kBins - 1; b > 0; --b) {
      right.add(bins[b]);
      right_cost[b] = right.cost();
    }
    std::pair<int, double> best{0, 0};
    for (size_t b = 1; b < kBins; ++b) {
      left.add(bins[b - 1]);
      if (left.count == 0 || left.count == last - first) continue;
      const double value = left.cost() + right_cost[b];
      if (best.first == 0 || value < best.second) best = {static_cast<int>(b), value};
    }
    return best;
  }

  std::span<const LightBounds> lights_;
  bool halve_;
  std::vector<uint32_t> order_;
  std::vector<BinaryNode> nodes_;
  BinaryNode root_;
};

double radius_of(const LightBounds& b) {
  return b.radius >= 0 ? b.radius : 0.5 * glm::length(b.box_max - b.box_min);
}

/// Collapses a binary tree into the table's groups of children.
class TableWriter {
 public:
  TableWriter(const BinaryBuilder& tree, std::span<const uint32_t> rows, std::vector<glm::uvec4>& table)
      : tree_(tree), rows_(rows), table_(table), where_(rows.size()) {}

  /// False when the tree is too deep for the trails.
  bool write(uint32_t first_unit) {
    const std::vector<BinaryNode> units = opened(tree_.root());
    const uint32_t number = append(units);
    for (size_t i = 0; i < units.size(); ++i)
      if (!descend(units[i], number + static_cast<uint32_t>(i), {first_unit + static_cast<uint32_t>(i), 0}, 0))
        return false;
    return true;
  }
  std::vector<glm::uvec2> where() && { return std::move(where_); }

 private:
  /// The children of a wide node.
  std::vector<BinaryNode> opened(const BinaryNode& node) const {
    std::vector<BinaryNode> children = {node};
    while (children.size() < gpu::kLightNodeWidth) {
      size_t best = children.size();
      double largest = -1;
      for (size_t i = 0; i < children.size(); ++i) {
        const double radius = radius_of(children[i].bounds), size = children[i].bounds.power * radius * radius;
        if (!children[i].leaf && size > largest) best = i, largest = size;
      }
      if (best == children.size()) break;
      const size_t inner = children[best].index;
      children[best] = tree_.nodes()[2 * inner];
      children.insert(children.begin() + static_cast<std::ptrdiff_t>(best) + 1, tree_.nodes()[2 * inner + 1]);
    }
    return children;
  }

  /// Rows for a group of children, whose words follow; the number of the first.
  uint32_t append(const std::vector<BinaryNode>& children) {
    const auto number = static_cast<uint32_t>((table_.size() - gpu::kLightTableHeaderRows) / gpu::kLightNodeRows);
    for (const BinaryNode& child : children)
      append_light_bounds(child.bounds, child.leaf ? rows_[child.index] : gpu::kLightNode, table_);
    return number;
  }

  bool descend(const BinaryNode& node, uint32_t number, glm::uvec2 where, uint32_t level) {
    if (node.leaf) {
      where_[node.index] = where;
      return true;
    }
    if (level == gpu::kLightTrailLevels) return false;
    const std::vector<BinaryNode> children = opened(node);
    const uint32_t first = append(children);
    table_[gpu::kLightTableHeaderRows + gpu::kLightNodeRows * number + 2].w =
        gpu::kLightNode | static_cast<uint32_t>(children.size() - 1) << gpu::kLightNodeCountShift | first;
    for (uint32_t i = 0; i < children.size(); ++i) {
      glm::uvec2 below = where;
      if (level < 8)
        below.x |= i << (8 + 3 * level);
      else
        below.y |= i << (3 * (level - 8));
      if (!descend(children[i], first + i, below, level + 1)) return false;
    }
    return true;
  }

  const BinaryBuilder& tree_;
  std::span<const uint32_t> rows_;
  std::vector<glm::uvec4>& table_;
  std::vector<glm::uvec2> where_;
};

}  // namespace

LightBounds merge(const LightBounds& a, const LightBounds& b) {
  const Cone cone = merge_cones(a, b);
  LightBounds m;
  m.box_min = glm::min(a.box_min, b.box_min);
  m.box_max = glm::max(a.box_max, b.box_max);
  m.axis = cone.axis;
  m.theta_o = cone.theta_o;
  m.theta_e = std::max(a.theta_e, b.theta_e);
  m.power = a.power + b.power;
  return m;
}

void append_light_bounds(const LightBounds& bounds, uint32_t child, std::vector<glm::uvec4>& table) {
  const dvec3 c = centre_of(bounds);
  // Rounded up: the centre's own rounding must stay inside.
  const double size = std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)});
  const double radius = radius_of(bounds);
  const double rounded = radius > 0 ? radius * (1 + 1e-6) + size * 1.2e-7 : 0;
  // A margin of the angles, for float cosines in the kernel; a flat light's theta_o stays 0.
  const bool all = bounds.theta_o >= kPi - 1e-3;
  const double theta_o = bounds.theta_o == 0 ? 0 : bounds.theta_o + 5e-4;
  table.emplace_back(bits(c.x), bits(c.y), bits(c.z), bits(rounded));
  table.emplace_back(bits(bounds.axis.x), bits(bounds.axis.y), bits(bounds.axis.z), bits(bounds.power));
  const double cos_e = bounds.theta_e >= kPi / 2 - 1e-9 ? 0 : std::cos(bounds.theta_e + 1e-3);
  table.emplace_back(bits(all ? -1 : std::cos(theta_o)), bits(all ? 0 : std::sin(theta_o)), bits(cos_e), child);
}

std::vector<glm::uvec2> append_light_tree(std::span<const LightBounds> lights, std::span<const uint32_t> rows,
                                          uint32_t first_unit, std::vector<glm::uvec4>& table) {
  CHECK(!lights.empty() && lights.size() == rows.size());
  const size_t begin = table.size();
  for (const bool halve : {false, true}) {
    table.resize(begin);
    const BinaryBuilder tree(lights, halve);
    TableWriter writer(tree, rows, table);
    if (writer.write(first_unit)) return std::move(writer).where();
  }
  CHECK(false);  // a balanced tree is never too deep
  return {};
}

}  // namespace tachylite
