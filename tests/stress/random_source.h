#pragma once

#include <cmath>
#include <initializer_list>
#include <string>

#include <fmt/format.h>

#include "support/pcg32.h"

namespace tachylite::test {

/// Two streams of random numbers: what a scene is made of, and its numbers. Scenes of one theme share the first, so
/// that kernels compiled for one serve all of them.
class RandomSource {
 public:
  RandomSource(uint64_t theme, uint64_t scene, int generation) : generation_(generation), kind_(theme), value_(scene) {}

  /// Whether the scene may have what the first generator lacked, and what the second did. Only then may that draw
  /// numbers, or old seeds would no longer make their scenes.
  bool wide() const { return generation_ >= 1; }
  bool nested() const { return generation_ >= 2; }

  // From the theme.
  bool chance(double probability) { return kind_.uniform() < probability; }
  int below(int n) { return static_cast<int>(kind_.below(static_cast<uint32_t>(n))); }
  int between(int low, int high) { return low + below(high - low + 1); }
  std::string pick(std::initializer_list<const char*> words) {
    return *(words.begin() + below(static_cast<int>(words.size())));
  }

  // From the scene.
  double uniform(double low, double high) { return low + (high - low) * value_.uniform(); }
  double log_uniform(double low, double high) { return low * std::exp(std::log(high / low) * value_.uniform()); }
  int number(int low, int high) { return low + static_cast<int>(value_.below(static_cast<uint32_t>(high - low + 1))); }
  glm::vec3 direction() { return value_.direction(); }
  std::string rgb(double low, double high) {
    const double r = uniform(low, high), g = uniform(low, high), b = uniform(low, high);
    return fmt::format("{:.4g}, {:.4g}, {:.4g}", r, g, b);
  }
  std::string point(double low, double high) { return rgb(low, high); }

 private:
  int generation_;
  Pcg32 kind_, value_;
};

}  // namespace tachylite::test
