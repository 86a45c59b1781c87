#pragma once

// Axis-aligned boxes of floats, four lanes wide so that a union is two instructions. Lane 3 is always zero.

#include <cstdint>
#include <cstring>

namespace tachylite {

using Lanes = float __attribute__((vector_size(16)));
using IntLanes = int32_t __attribute__((vector_size(16)));

inline Lanes min(Lanes a, Lanes b) {
  return a < b ? a : b;
}
inline Lanes max(Lanes a, Lanes b) {
  return a > b ? a : b;
}

struct Box {
  static constexpr float kHuge = 3e38f;
  Lanes lo{kHuge, kHuge, kHuge, 0}, hi{-kHuge, -kHuge, -kHuge, 0};

  void grow(const Box& b) {
    lo = min(lo, b.lo);
    hi = max(hi, b.hi);
  }
  void grow(Lanes p) {
    lo = min(lo, p);
    hi = max(hi, p);
  }
};

inline Box merge(Box a, const Box& b) {
  a.grow(b);
  return a;
}

/// Half the surface area [length^2]; finite for coordinates up to kMaxCoordinate.
inline float half_area(const Box& b) {
  const Lanes d = b.hi - b.lo;
  return d[0] * (d[1] + d[2]) + d[1] * d[2];
}
constexpr float kMaxCoordinate = 1e18f;

/// Twice the centre.
inline Lanes centre2(const Box& b) {
  return b.lo + b.hi;
}

}  // namespace tachylite
