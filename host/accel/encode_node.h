#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "accel/bvh.h"
#include "accel/collapse_bvh8.h"

namespace tachylite {

/// The grid of one axis of a node: coordinates are p + q * 2^(exponent - 127), q in 0..255. Rounding is
/// outwards and leaves kBvhBoxMargin steps, checked without rounding.
struct QuantisationGrid {
  float p;
  uint32_t exponent;  // biased, 1..254: the least whose grid covers the interval
  float step;
  double inverse_step;

  QuantisationGrid(float lo, float hi);
  float decode(uint32_t q) const { return p + static_cast<float>(q) * step; }
  uint32_t lower(float x) const;  // greatest q that decodes to at most x
  uint32_t upper(float x) const;  // least q that decodes to at least x

 private:
  void set_step(float lo);  // and p, from the exponent
  double exact(uint32_t q) const { return static_cast<double>(p) + static_cast<double>(q) * step; }
  double margin() const { return static_cast<double>(step) * gpu::kBvhBoxMargin; }
  bool at_most(uint32_t q, float x) const { return exact(q) <= x - margin(); }
  bool at_least(uint32_t q, float x) const { return exact(q) >= x + margin(); }
};

/// A wide node before its encoding.
struct WideNode {
  uint32_t binary = kEmptySlot;            // has its box
  uint32_t address = 0;                    // in nodes
  uint32_t child_base = 0, leaf_base = 0;  // as in shared/bvh.h
  WideChildren slots{};
};

/// Which primitives of the leaves are curved: those from `first` on, in this order.
struct CurvedLeaves {
  uint32_t first = 0;
  std::span<const CurvedPrimitive> primitives;
  uint32_t kind(uint32_t primitive) const {
    return primitive < first ? gpu::kLeafTriangles : primitives[primitive - first].kind;
  }
};

/// Sums of half areas of a node's children, boxes as quantised.
struct ChildAreas {
  double inner = 0, leaves = 0;
};

/// Writes the kBvhNodeRows rows of a node.
ChildAreas encode_node(std::span<const BinaryNode> nodes, const WideNode& wide, const CurvedLeaves& curved,
                       glm::uvec4* rows);

}  // namespace tachylite
