#include <algorithm>

#include "accel/binary_bvh.h"
#include "base/parallel.h"

namespace tachylite {
namespace {

struct Move {
  float gain = 0;  // of total half area
  uint32_t node = 0, target = 0;
};

/// Searches run in parallel against an unchanging tree; moves are made one after another, best first, leaving
/// out those whose surroundings an earlier one has changed. (The paper makes them in parallel, under locks.)
class Reinserter {
 public:
  explicit Reinserter(std::vector<BinaryNode>& nodes) : nodes_(nodes), parents_(nodes.size() / 2, 0) {
    parallel_for(BinaryBvh::kRoot, nodes.size(), kGrain, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i)
        if (!nodes_[i].is_leaf) parents_[nodes_[i].first / 2] = static_cast<uint32_t>(i);
    });
  }

  /// Tries to move `count` nodes; the half area that was saved.
  double pass(size_t count) {
    std::vector<Move> moves = find_moves(misplaced_nodes(count));
    std::erase_if(moves, [](const Move& m) { return m.target == 0; });
    std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
      return a.gain > b.gain || (a.gain == b.gain && a.node < b.node);
    });
    touched_.assign(nodes_.size(), 0);
    double saved = 0;
    for (const Move& m : moves) {
      const uint32_t slots[] = {m.node, m.node ^ 1, parent(m.node), m.target};
      if (std::any_of(std::begin(slots), std::end(slots), [&](uint32_t s) { return touched_[s]; })) continue;
      if (is_ancestor(m.node, m.target)) continue;  // by an earlier move
      for (uint32_t s : slots) touched_[s] = 1;
      saved += apply(m);
    }
    return saved;
  }

 private:
  static constexpr size_t kGrain = 1 << 14;

  uint32_t parent(uint32_t node) const { return parents_[node / 2]; }

  /// The `count` nodes whose removal alone saves most: it puts the sibling in the parent's place.
  std::vector<uint32_t> misplaced_nodes(size_t count) const {
    struct Candidate {
      float saved;
      uint32_t node;
    };
    constexpr uint32_t kFirst = 2;  // the root stays
    std::vector<Candidate> all(nodes_.size() - kFirst);
    parallel_for(0, all.size(), kGrain, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) {
        const auto node = static_cast<uint32_t>(i + kFirst);
        all[i] = {half_area(nodes_[parent(node)].box()) - half_area(nodes_[node ^ 1].box()), node};
      }
    });
    if (count < all.size())
      std::nth_element(all.begin(), all.begin() + static_cast<ptrdiff_t>(count), all.end(),
                       [](const Candidate& a, const Candidate& b) {
                         return a.saved > b.saved || (a.saved == b.saved && a.node < b.node);
                       });
    std::vector<uint32_t> nodes(std::min(count, all.size()));
    for (size_t i = 0; i < nodes.size(); ++i) nodes[i] = all[i].node;
    return nodes;
  }

  std::vector<Move> find_moves(const std::vector<uint32_t>& candidates) const {
    std::vector<Move> moves(candidates.size());
    parallel_for(0, candidates.size(), 256, [&](size_t first, size_t last) {
      std::vector<Pending> stack;
      for (size_t i = first; i < last; ++i) moves[i] = find_move(candidates[i], stack);
    });
    return moves;
  }

  struct Pending {
    float budget;    // what is saved so far, with the growth of this pair's parent and all above it paid
    uint32_t first;  // sibling pair to be visited
  };

  /// Branch and bound (algorithm 1 of the paper): goes up from the node, and at each level searches the
  /// subtree beside the path for the place where insertion costs least. Other than in the paper, nodes on the
  /// path are places, too.
  Move find_move(uint32_t node, std::vector<Pending>& stack) const {
    const Box box = nodes_[node].box();
    const float area = half_area(box);  // the least that any insertion costs
    Move best{0, node, 0};
    const auto descend = [&](uint32_t target, float budget) {
      if (!nodes_[target].is_leaf && budget - area > best.gain)
        stack.push_back({budget, nodes_[target].first});
    };
    const auto consider = [&](uint32_t target, float budget) {
      const Box target_box = nodes_[target].box();
      const float gain = budget - half_area(merge(target_box, box));
      if (gain > best.gain) best = {gain, node, target};
      descend(target, gain + half_area(target_box));
    };
    const auto search = [&] {
      while (!stack.empty()) {
        const Pending p = stack.back();
        stack.pop_back();
        if (p.budget - area <= best.gain) continue;
        consider(p.first, p.budget);
        consider(p.first + 1, p.budget);
      }
    };

    // Taking the node away saves its parent, and shrinks the nodes above. Beside the sibling is where it
    // already is.
    uint32_t pivot = parent(node);
    Box shrunk = nodes_[node ^ 1].box();
    float saved = half_area(nodes_[pivot].box());
    descend(node ^ 1, half_area(shrunk));
    search();
    while (pivot != BinaryBvh::kRoot) {
      consider(pivot ^ 1, saved);
      search();
      shrunk.grow(nodes_[pivot ^ 1].box());
      pivot = parent(pivot);
      const float before = half_area(nodes_[pivot].box());
      saved += before - half_area(shrunk);
      if (saved - before > best.gain && pivot != BinaryBvh::kRoot) best = {saved - before, node, pivot};
    }
    return best;
  }

  bool is_ancestor(uint32_t node, uint32_t of) const {
    for (uint32_t n = of; n != BinaryBvh::kRoot; n = parent(n))
      if (n == node) return true;
    return false;
  }

  void put(uint32_t slot, const BinaryNode& content) {
    nodes_[slot] = content;
    if (!content.is_leaf) parents_[content.first / 2] = slot;
  }

  /// Tightens the boxes from `node` upwards; the half area that was saved.
  double refit(uint32_t node) {
    double saved = 0;
    for (;; node = parent(node)) {
      BinaryNode& n = nodes_[node];
      const Box box = merge(nodes_[n.first].box(), nodes_[n.first + 1].box());
      const float before = half_area(n.box()), after = half_area(box);
      bool same = true;
      for (int a = 0; a < 3; ++a) same = same && n.lo[a] == box.lo[a] && n.hi[a] == box.hi[a];
      if (same) break;
      n.set_box(box);
      saved += static_cast<double>(before) - after;
      if (node == BinaryBvh::kRoot) break;
    }
    return saved;
  }

  double apply(const Move& m) {
    const uint32_t sibling = m.node ^ 1, hole = parent(m.node);
    double saved = half_area(nodes_[hole].box());
    put(hole, nodes_[sibling]);
    if (hole != BinaryBvh::kRoot) saved += refit(parent(hole));
    put(sibling, nodes_[m.target]);
    BinaryNode& joint = nodes_[m.target];
    joint.first = std::min(m.node, sibling);
    joint.is_leaf = 0;
    const Box box = merge(nodes_[m.node].box(), nodes_[sibling].box());
    joint.set_box(box);
    parents_[m.node / 2] = m.target;
    saved -= half_area(box);
    return m.target == BinaryBvh::kRoot ? saved : saved + refit(parent(m.target));
  }

  std::vector<BinaryNode>& nodes_;
  std::vector<uint32_t> parents_;  // of each sibling pair
  std::vector<uint8_t> touched_;
};

}  // namespace

double optimise_binary_bvh(BinaryBvh& bvh, int max_passes) {
  constexpr double kFraction =
      0.05;  // of the nodes, in each pass: many small passes reach more than few large ones
  constexpr double kWorthwhile = 1e-3;  // of the total area, in a pass
  if (bvh.nodes.size() < 8) return 0;
  double area = 0, saved = 0;
  for (size_t i = BinaryBvh::kRoot; i < bvh.nodes.size(); ++i)
    if (!bvh.nodes[i].is_leaf) area += half_area(bvh.nodes[i].box());
  Reinserter reinserter(bvh.nodes);
  for (int i = 0; i < max_passes; ++i) {
    const double pass =
        reinserter.pass(static_cast<size_t>(kFraction * static_cast<double>(bvh.nodes.size())) + 1);
    saved += pass;
    if (pass < kWorthwhile * (area - saved)) break;
  }
  return saved;
}

}  // namespace tachylite
