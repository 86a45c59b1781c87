#include "reference/bvh2.h"

#include <array>
#include <numeric>

namespace tachylite::reference {
namespace {

constexpr int kBins = 16;
constexpr uint32_t kLeafItems = 2;  // always a leaf
constexpr int kMaxDepth = 60;  // then halves by count, which ends within 32 more levels: the stack suffices

struct Split {
  int axis = -1;
  double position = 0;
  double cost = kInfinity;  // half area times items, both sides
};

Split best_split(const std::vector<Box>& boxes, const std::vector<uint32_t>& items, uint32_t first,
                 uint32_t count, const Box& centres) {
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = centres.low[axis], extent = centres.high[axis] - low;
    if (!(extent > 0)) continue;
    std::array<Box, kBins> bin_boxes;
    std::array<uint32_t, kBins> bin_counts{};
    for (uint32_t i = first; i < first + count; ++i) {
      const Box& box = boxes[items[i]];
      const int b = std::min(kBins - 1, static_cast<int>((box.centre()[axis] - low) / extent * kBins));
      bin_boxes[static_cast<size_t>(b)].grow(box);
      ++bin_counts[static_cast<size_t>(b)];
    }
    std::array<double, kBins> right_costs{};  // of the bins b and above
    Box box;
    uint32_t n = 0;
    for (size_t b = kBins; b-- > 0;) {
      box.grow(bin_boxes[b]);
      n += bin_counts[b];
      right_costs[b] = n * box.half_area();
    }
    box = Box();
    n = 0;
    for (size_t b = 0; b + 1 < kBins; ++b) {
      box.grow(bin_boxes[b]);
      n += bin_counts[b];
      if (n == 0 || n == count) continue;
      const double cost = n * box.half_area() + right_costs[b + 1];
      if (cost < best.cost) best = {axis, low + extent * static_cast<double>(b + 1) / kBins, cost};
    }
  }
  return best;
}

}  // namespace

Bvh2::Bvh2(const std::vector<Box>& boxes) {
  items_.resize(boxes.size());
  std::iota(items_.begin(), items_.end(), 0u);
  if (boxes.empty()) return;

  struct Task {
    uint32_t node, first, count;
    int depth;
  };
  nodes_.emplace_back();
  std::vector<Task> tasks{{0, 0, static_cast<uint32_t>(boxes.size()), 0}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();

    // Bound the items and their centres.
    Box box, centres;
    for (uint32_t i = task.first; i < task.first + task.count; ++i) {
      box.grow(boxes[items_[i]]);
      centres.grow(boxes[items_[i]].centre());
    }
    Node node{box, task.first, task.count, 0};

    // Split where the heuristic gains over a leaf; by count where it finds nothing but the leaf would be
    // large.
    if (task.count > kLeafItems) {
      const Split split = best_split(boxes, items_, task.first, task.count, centres);
      const auto begin = items_.begin() + task.first, end = begin + task.count;
      auto middle = begin;
      if (split.axis >= 0 && task.depth < kMaxDepth &&
          split.cost + box.half_area() < task.count * box.half_area()) {
        node.axis = split.axis;
        middle = std::partition(begin, end,
                                [&](uint32_t i) { return boxes[i].centre()[split.axis] < split.position; });
      }
      if ((middle == begin || middle == end) && task.count > 8) {
        const dvec3 extent = centres.high - centres.low;
        node.axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        middle = begin + task.count / 2;
        std::nth_element(begin, middle, end, [&](uint32_t a, uint32_t b) {
          return boxes[a].centre()[node.axis] < boxes[b].centre()[node.axis];
        });
      }
      if (middle != begin && middle != end) {
        const auto left = static_cast<uint32_t>(middle - begin);
        const auto children = static_cast<uint32_t>(nodes_.size());
        nodes_.resize(nodes_.size() + 2);
        tasks.push_back({children, task.first, left, task.depth + 1});
        tasks.push_back({children + 1, task.first + left, task.count - left, task.depth + 1});
        node.first = children;
        node.count = 0;
      }
    }
    nodes_[task.node] = node;
  }
}

}  // namespace tachylite::reference
