#pragma once

#include <cstdint>

#include "reference/math.h"

namespace tachylite::reference {

/// Independent uniform numbers, one stream a path: SplitMix64 (Steele, Lea and Flood 2014), started at a hash
/// of (seed, pixel, sample), so that an image does not depend on threads, tiles or the order of samples.
class Random {
 public:
  Random(uint64_t seed, uint64_t pixel, uint64_t sample) {
    state_ = seed;
    state_ = next() ^ pixel;
    state_ = next() ^ sample;
    state_ = next();
  }
  /// Uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  dvec2 uniform2() {
    const double x = uniform();
    return {x, uniform()};
  }

 private:
  uint64_t next() {
    uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  uint64_t state_;
};

}  // namespace tachylite::reference
