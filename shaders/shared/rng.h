// Hashes on 32-bit integers, the same bits in C++ and GLSL. No state: whatever needs random bits hashes a key.
#ifndef TACHYLITE_SHARED_RNG_H
#define TACHYLITE_SHARED_RNG_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

/// A bijection of 32 bits: O'Neill 2014 (PCG, RXS-M-XS), in the form of Jarzynski and Olano 2020, "Hash Functions for
/// GPU Rendering", listing "pcg".
TACHYLITE_INLINE uint hash_pcg(uint x) {
  uint state = x * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

/// A bijection of `a` for every `b`.
TACHYLITE_INLINE uint hash_pair(uint a, uint b) { return hash_pcg(a ^ hash_pcg(b)); }

/// Four 32-bit words from four: Jarzynski and Olano 2020, listing "pcg4d".
TACHYLITE_INLINE uvec4 hash_pcg4d(uvec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v.x ^= v.x >> 16u;
  v.y ^= v.y >> 16u;
  v.z ^= v.z >> 16u;
  v.w ^= v.w >> 16u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

/// Uniform in [0, 1): a multiple of 2^-24, so that it is exact and never 1.
TACHYLITE_INLINE float unit_float(uint bits) { return float(bits >> 8u) * (1.0f / 16777216.0f); }

TACHYLITE_SHARED_END
#endif
