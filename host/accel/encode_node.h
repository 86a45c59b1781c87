#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "accel/collapse_bvh8.h"

namespace tachylite {

/// The grid of one axis of a node: coordinates are p + q * 2^(exponent - 127), q in 0..255. Rounding is
/// outwards, checked against the decoded coordinate both in float, as a kernel computes it, and without
/// rounding.
struct QuantisationGrid {
  float p;
  uint32_t exponent;  // biased, 1..254: the least whose grid covers the interval
  float step;

  QuantisationGrid(float lo, float hi);
  float decode(uint32_t q) const { return p + static_cast<float>(q) * step; }
  uint32_t lower(float x) const;  // greatest q that decodes to at most x
  uint32_t upper(float x) const;  // least q that decodes to at least x

 private:
  double exact(uint32_t q) const { return static_cast<double>(p) + static_cast<double>(q) * step; }
  bool at_most(uint32_t q, float x) const { return decode(q) <= x && exact(q) <= x; }
  bool at_least(uint32_t q, float x) const { return decode(q) >= x && exact(q) >= x; }
};

/// A wide node before its encoding.
struct WideNode {
  uint32_t binary = kEmptySlot;            // has its box
  uint32_t address = 0;                    // in nodes
  uint32_t child_base = 0, leaf_base = 0;  // as in shared/bvh.h
  WideChildren slots{};
};

/// Sums of half areas of a node's children, boxes as quantised.
struct ChildAreas {
  double inner = 0, leaves = 0;
};

/// Writes the kBvhNodeRows rows of a node. Leaves with a primitive of at least `first_curved` are curved.
ChildAreas encode_node(const std::vector<BinaryNode>& nodes, const WideNode& wide, uint32_t first_curved,
                       glm::uvec4* rows);

}  // namespace tachylite
