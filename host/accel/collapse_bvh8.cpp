#include "accel/collapse_bvh8.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"

namespace tachylite {

Bvh8Collapse::Bvh8Collapse(std::span<const BinaryNode> nodes)
    : nodes_(nodes), subtrees_(nodes.size() / 2) {
  solve(BinaryBvh::kRoot, 0);
}

void Bvh8Collapse::solve(uint32_t node, int depth) {
  constexpr int kForks = 10;  // levels that are solved in parallel
  if (nodes_[node].is_leaf) return;
  const uint32_t first = nodes_[node].first;
  if (depth < kForks) {
    parallel_invoke([&] { solve(first, depth + 1); }, [&] { solve(first + 1, depth + 1); });
  } else {
    solve(first, depth + 1);
    solve(first + 1, depth + 1);
  }

  const Costs left = costs(first), right = costs(first + 1);
  const auto divided = [&](size_t trees) {  // left and right share the trees
    float best = std::numeric_limits<float>::infinity();
    for (size_t k = 1; k < trees; ++k) best = std::min(best, left[k - 1] + right[trees - k - 1]);
    return best;
  };
  Subtree& s = subtrees_[first / 2];
  s.leaves = leaves(first) + leaves(first + 1);
  s.costs[0] = half_area(nodes_[node].box()) + divided(kBvhWidth);
  for (size_t trees = 2; trees < kBvhWidth; ++trees)
    s.costs[trees - 1] = std::min(s.costs[trees - 2], divided(trees));
}

WideChildren Bvh8Collapse::children(uint32_t node) const {
  WideChildren out{};
  uint32_t count = 0;
  if (nodes_[node].is_leaf)
    out[0] = node;
  else
    split(node, kBvhWidth, out, count);
  return out;
}

void Bvh8Collapse::forest(uint32_t node, uint32_t trees, WideChildren& out, uint32_t& count) const {
  if (nodes_[node].is_leaf) {
    out[count++] = node;
    return;
  }
  const Costs& c = subtrees_[nodes_[node].first / 2].costs;
  while (trees > 1 && c[trees - 1] == c[trees - 2]) --trees;
  if (trees == 1)
    out[count++] = node;
  else
    split(node, trees, out, count);
}

void Bvh8Collapse::split(uint32_t node, uint32_t trees, WideChildren& out, uint32_t& count) const {
  const uint32_t first = nodes_[node].first;
  const Costs left = costs(first), right = costs(first + 1);
  const auto cost = [&](uint32_t k) { return left[k - 1] + right[trees - k - 1]; };
  uint32_t best = 1;
  for (uint32_t k = 2; k < trees; ++k)
    if (cost(k) < cost(best)) best = k;
  forest(first, best, out, count);
  forest(first + 1, trees - best, out, count);
}

}  // namespace tachylite
