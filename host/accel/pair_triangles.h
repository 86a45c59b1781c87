#pragma once

#include <array>
#include <cstdint>

#include "accel/bvh.h"

namespace tachylite {

/// Two triangles with a common edge, of equal winding, or one alone (then second == kNoTriangle), turned so that its
/// longest edge stands where the common one would.
/// In the order of shared/bvh.h, vertex k of a leaf's triangle is vertex (k + rotation) % 3 of the mesh's.
struct TrianglePair {
  static constexpr uint32_t kNoTriangle = 0xffffffffu;
  uint32_t first = kNoTriangle, second = kNoTriangle;
  uint32_t rotation = 0;  // of the first in bits 0-1, of the second in bits 2-3
};

/// v0 v1 v2 v3 of shared/bvh.h.
std::array<glm::vec3, 4> pair_vertices(const BvhInput& input, const TrianglePair& pair);

/// Whether these corners in order are a parallelogram's, but for rounding.
bool is_parallelogram(const std::array<glm::dvec3, 4>& corners);

struct Pairing {
  BulkVector<TrianglePair> pairs;  // in the order of their first triangles
  uint64_t dropped = 0;             // triangles of area 0 (in double precision)
};

/// Matches triangles greedily along shared edges, the edge that saves most surface area of boxes first. An
/// edge is shared if its end points are equal bit for bit. Pairs whose box has a larger area than
/// `max_area_ratio` times the sum of both triangles' boxes are not made. Deterministic. Throws InputError on
/// a coordinate that is not finite or larger than kMaxCoordinate.
Pairing pair_triangles(const BvhInput& input, double max_area_ratio);

}  // namespace tachylite
