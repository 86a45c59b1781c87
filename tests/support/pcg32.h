#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace tachylite::test {

/// PCG32 (O'Neill 2014): the same numbers on every machine, which the distributions of <random> do not promise.
class Pcg32 {
 public:
  explicit Pcg32(uint64_t seed) : state_(seed * 2 + 1) { next(); }

  uint32_t next() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005ull + 1442695040888963407ull;
    const auto xorshifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    const auto rotation = static_cast<uint32_t>(old >> 59);
    return (xorshifted >> rotation) | (xorshifted << ((32 - rotation) & 31));
  }
  uint32_t below(uint32_t n) { return static_cast<uint32_t>((uint64_t{next()} * n) >> 32); }
  /// In [0, 1).
  float uniform() { return static_cast<float>(next() >> 8) * 0x1p-24f; }
  double uniform_double() { return (next() * 0x1p32 + next()) * 0x1p-64; }
  float uniform(float low, float high) { return low + (high - low) * uniform(); }
  glm::vec3 in_box(const glm::vec3& low, const glm::vec3& high) {
    const float x = uniform(low.x, high.x), y = uniform(low.y, high.y), z = uniform(low.z, high.z);
    return {x, y, z};
  }
  /// Uniform on the unit sphere.
  glm::vec3 direction() {
    const float z = 1 - 2 * uniform(), phi = 6.2831853f * uniform();
    const float r = glm::sqrt(glm::max(0.0f, 1 - z * z));
    return {r * glm::cos(phi), r * glm::sin(phi), z};
  }
  /// Cosine-distributed about the unit n.
  glm::vec3 cosine_direction(const glm::vec3& n) {
    const glm::vec3 d = n + direction();
    const float length = glm::length(d);
    return length > 1e-3f ? d / length : n;
  }

 private:
  uint64_t state_;
};

}  // namespace tachylite::test
