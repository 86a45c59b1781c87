#include "accel/encode_node.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace tachylite {

QuantisationGrid::QuantisationGrid(float lo, float hi) : exponent(1) {
  // The margin may move p by more than a step, where floats are sparse: the range to cover begins at p.
  set_step(lo);
  int e = 0;
  std::frexp((static_cast<double>(hi) - p) / 255, &e);
  exponent = static_cast<uint32_t>(std::clamp(e - 1 + 127, 1, 254));
  for (;; ++exponent) {
    set_step(lo);
    if (at_least(255, hi)) break;
  }
}

void QuantisationGrid::set_step(float lo) {
  step = std::bit_cast<float>(exponent << 23);
  inverse_step = 1.0 / step;
  const double lowered = static_cast<double>(lo) - margin();
  p = static_cast<float>(lowered);
  if (p > lowered) p = std::nextafter(p, -std::numeric_limits<float>::infinity());
}

uint32_t QuantisationGrid::lower(float x) const {
  auto q = static_cast<uint32_t>(std::min(255.0, (static_cast<double>(x) - p) * inverse_step));
  while (q > 0 && !at_most(q, x)) --q;
  return q;
}

uint32_t QuantisationGrid::upper(float x) const {
  auto q = static_cast<uint32_t>(std::min(255.0, (static_cast<double>(x) - p) * inverse_step));
  while (!at_least(q, x)) ++q;
  return q;
}

ChildAreas encode_node(std::span<const BinaryNode> nodes, const WideNode& wide, const CurvedLeaves& curved,
                       glm::uvec4* rows) {
  const BinaryNode& n = nodes[wide.binary];
  const std::array<QuantisationGrid, 3> grid{QuantisationGrid(n.lo[0], n.hi[0]),
                                             QuantisationGrid(n.lo[1], n.hi[1]),
                                             QuantisationGrid(n.lo[2], n.hi[2])};
  uint32_t inner = 0, leaf = 0, kinds = 0;
  std::array<std::array<uint32_t, 2>, 3> lo, hi;  // [axis][slots 0-3, 4-7]
  lo.fill({0xffffffffu, 0xffffffffu});
  hi.fill({0, 0});
  ChildAreas areas;
  for (uint32_t s = 0; s < kBvhWidth; ++s) {
    if (wide.slots[s] == kEmptySlot) continue;
    const BinaryNode& child = nodes[wide.slots[s]];
    Box quantised;
    for (size_t a = 0; a < 3; ++a) {
      const uint32_t l = grid[a].lower(child.lo[a]), h = grid[a].upper(child.hi[a]), shift = 8 * (s & 3);
      lo[a][s / 4] ^= (0xffu ^ l) << shift;
      hi[a][s / 4] |= h << shift;
      quantised.lo[static_cast<int>(a)] = grid[a].decode(l);
      quantised.hi[static_cast<int>(a)] = grid[a].decode(h);
    }
    (child.is_leaf ? leaf : inner) |= 1u << s;
    (child.is_leaf ? areas.leaves : areas.inner) += half_area(quantised);
    if (child.is_leaf) kinds |= curved.kind(child.first) << (2 * s);
  }
  rows[0] = {std::bit_cast<uint32_t>(grid[0].p), std::bit_cast<uint32_t>(grid[1].p),
             std::bit_cast<uint32_t>(grid[2].p),
             grid[0].exponent | grid[1].exponent << 8 | grid[2].exponent << 16 | inner << 24};
  rows[1] = {wide.child_base, wide.leaf_base, 0, leaf | kinds << 16};
  rows[2] = {lo[0][0], lo[0][1], lo[1][0], lo[1][1]};
  rows[3] = {lo[2][0], lo[2][1], hi[0][0], hi[0][1]};
  rows[4] = {hi[1][0], hi[1][1], hi[2][0], hi[2][1]};
  return areas;
}

}  // namespace tachylite
