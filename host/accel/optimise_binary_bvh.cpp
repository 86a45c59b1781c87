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
/// Other than in the paper, a node that found no better place is not asked again until a box beside it changes: most
/// find none, and without that every pass asks them anew.
class Reinserter {
 public:
  /// Moves only the children of the `most` largest nodes.
  Reinserter(std::span<BinaryNode> nodes, size_t most)
      : nodes_(nodes), parents_(nodes.size() / 2, 0), settled_(nodes.size(), 0), touched_(nodes.size(), 0) {
    parallel_for(BinaryBvh::kRoot, nodes.size(), kMeshGrain, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i)
        if (!nodes_[i].is_leaf) parents_[nodes_[i].first / 2] = static_cast<uint32_t>(i);
    });
    BulkVector<Candidate> parents(nodes.size() / 2 - 1);
    parallel_for(0, parents.size(), kMeshGrain, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) {
        const uint32_t parent = parents_[i + 1];
        parents[i] = {half_area(nodes_[parent].box()), nodes_[parent].first};
      }
    });
    keep_best(parents, most);
    for (const Candidate& c : parents) {
      movable_.push_back(c.node);
      movable_.push_back(c.node + 1);
    }
  }

  /// Tries to move `count` nodes; the half area that was saved.
  double pass(size_t count) {
    std::vector<Move> moves = find_moves(misplaced_nodes(count));
    for (const Move& m : moves) settled_[m.node] = m.target == 0;
    std::erase_if(moves, [](const Move& m) { return m.target == 0; });
    std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
      return a.gain > b.gain || (a.gain == b.gain && a.node < b.node);
    });
    std::vector<uint32_t> all_touched;
    double saved = 0;
    for (const Move& m : moves) {
      const uint32_t slots[] = {m.node, m.node ^ 1, parent(m.node), m.target};
      if (std::any_of(std::begin(slots), std::end(slots), [&](uint32_t s) { return touched_[s]; })) continue;
      if (is_ancestor(m.node, m.target)) continue;  // by an earlier move
      for (uint32_t s : slots) {
        touched_[s] = 1;
        settled_[s] = 0;
        all_touched.push_back(s);
      }
      saved += apply(m);
    }
    for (uint32_t s : all_touched) touched_[s] = 0;
    return saved;
  }

 private:
  uint32_t parent(uint32_t node) const { return parents_[node / 2]; }

  struct Candidate {
    float area;
    uint32_t node;
  };

  /// About `count`: the bound is that of a sample. They stay in order, so that what looks at their nodes goes through
  /// memory in that of the tree.
  void keep_best(BulkVector<Candidate>& candidates, size_t count) {
    if (count >= candidates.size()) return;
    const auto better = [](const Candidate& a, const Candidate& b) {
      return a.area > b.area || (a.area == b.area && a.node < b.node);
    };
    constexpr size_t kSampled = 4096;  // of `count`
    const size_t stride = std::max<size_t>(1, count / kSampled);
    ranked_.clear();
    for (size_t i = 0; i < candidates.size(); i += stride) ranked_.push_back(candidates[i]);
    const auto first_left_out = ranked_.begin() + static_cast<ptrdiff_t>(count / stride);
    std::nth_element(ranked_.begin(), first_left_out, ranked_.end(), better);
    std::erase_if(candidates, [&](const Candidate& c) { return !better(c, *first_left_out); });
  }

  /// The `count` nodes whose removal alone saves most, as it puts the sibling in the parent's place.
  std::span<const Candidate> misplaced_nodes(size_t count) {
    misplaced_.resize(movable_.size());
    const auto movable = [&](size_t first, size_t last) { return std::span(movable_).subspan(first, last - first); };
    misplaced_.resize(parallel_scan(
        movable_.size(),
        [&](size_t first, size_t last) {
          return static_cast<size_t>(
              std::ranges::count_if(movable(first, last), [&](uint32_t node) { return !settled_[node]; }));
        },
        [&](size_t first, size_t last, size_t at) {
          for (uint32_t node : movable(first, last))
            if (!settled_[node])
              misplaced_[at++] = {half_area(nodes_[parent(node)].box()) - half_area(nodes_[node ^ 1].box()), node};
        }));
    keep_best(misplaced_, count);
    return misplaced_;
  }

  std::vector<Move> find_moves(std::span<const Candidate> candidates) const {
    std::vector<Move> moves(candidates.size());
    parallel_for(0, candidates.size(), 256, [&](size_t first, size_t last) {
      std::vector<Pending> stack;
      for (size_t i = first; i < last; ++i) moves[i] = find_move(candidates[i].node, stack);
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
      settled_[node] = settled_[node ^ 1] = 0;
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

  const std::span<BinaryNode> nodes_;
  BulkVector<uint32_t> parents_;  // of each sibling pair
  std::vector<uint32_t> movable_;
  BulkVector<Candidate> misplaced_, ranked_;  // kept, so that not every pass touches new memory
  std::vector<uint8_t> settled_;  // nodes that found no better place
  std::vector<uint8_t> touched_;  // in this pass
};

}  // namespace

double optimise_binary_bvh(BinaryBvh& bvh, int max_passes) {
  constexpr double kFraction = 0.0025;  // of the nodes, in each pass: many small passes reach more than few large ones
  constexpr double kMovable = 0.05;    // of the nodes are parents of those that are moved
  constexpr size_t kLeast = 1500;      // of either
  constexpr double kWorthwhile = 1e-4;  // of the total area, in a pass
  if (bvh.nodes.size() < 8) return 0;
  const double area = expected_visits(bvh).inner * half_area(bvh.nodes[BinaryBvh::kRoot].box());
  double saved = 0;
  const auto part = [&](double fraction) {
    return std::max<size_t>(static_cast<size_t>(fraction * static_cast<double>(bvh.nodes.size())), kLeast);
  };
  Reinserter reinserter(bvh.nodes, part(kMovable));
  for (int i = 0; i < max_passes; ++i) {
    const double pass = reinserter.pass(part(kFraction));
    saved += pass;
    if (pass < kWorthwhile * (area - saved)) break;
  }
  return saved;
}

}  // namespace tachylite
