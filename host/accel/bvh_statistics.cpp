#include <fmt/format.h>

#include "accel/bvh.h"

namespace tachylite {

std::string describe(const BvhStatistics& s) {
  const double triangles = static_cast<double>(s.triangles - s.dropped);
  return fmt::format(
      "triangles        {} ({} degenerate ones left out)\n"
      "leaves           {} ({:.1f} % of triangles in {} pairs, {} curved{})\n"
      "nodes            {} binary, {} 8-wide with {:.2f} children each, depth {}\n"
      "SAH cost         {:.2f} binary, {:.2f} 8-wide ({:.2f} nodes, {:.2f} leaves a ray)\n"
      "bytes            {:.1f} MiB nodes, {:.1f} MiB leaves\n"
      "seconds          {:.3f} pairing, {:.3f} building, {:.3f} optimising, {:.3f} flattening\n",
      s.triangles, s.dropped, s.leaves,
      triangles > 0 ? 200.0 * static_cast<double>(s.pairs) / triangles : 0.0, s.pairs, s.curved,
      s.walls > 0 ? fmt::format(", {} walls outside of the tree", s.walls) : "", s.nodes2,
      s.nodes8, s.children_per_node, s.depth8, s.sah_cost2, s.sah_cost8, s.node_visits8, s.leaf_visits8,
      static_cast<double>(s.node_bytes) / 1048576.0, static_cast<double>(s.leaf_bytes) / 1048576.0,
      s.pair_seconds, s.build_seconds, s.optimise_seconds, s.flatten_seconds);
}

}  // namespace tachylite
