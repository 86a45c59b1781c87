#pragma once

// Bins on the sphere that fit a density of which nothing is known but samples: laid by a first set of them (the pilot),
// with integrals of the claimed density by adaptive quadrature. For lobes of any width, and such that the horizon cuts.

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace tachylite::test {

/// Rectangles in (s, phi) about +z, with theta = pi/2 + s |s|: the horizon is an edge of bins, and quadrature is denser
/// at it, for what a density does within the few hundredths of a degree above it.
class AdaptiveBins {
 public:
  /// w.r.t. solid angle [1/sr], at each of these directions.
  using Density = std::function<std::vector<double>(std::span<const glm::dvec3>)>;

  /// Each bin holds at least `fewest` samples of the pilot, or is a hemisphere. pilot: .xyz a direction, or zero for a
  /// refused sample, .w the claimed density there. `azimuth`: the middle of the range of phi.
  AdaptiveBins(std::span<const glm::vec4> pilot, size_t fewest, const glm::dvec3& azimuth);

  /// One entry a bin and one more: refused samples.
  size_t size() const { return bins_.size() + 1; }
  std::vector<double> count(std::span<const glm::vec4> directions) const;

  /// Expected counts of `samples` samples; what is left of 1 goes to the last entry. A cell is halved, across its longer
  /// side, until halving it both ways changes its integral by less than `tolerance`, and while the density at a sample
  /// of the pilot is more than twice that at any node: a peak lies between them. A rest that quadrature cannot tell from none is 1e-9.
  std::vector<double> expected(const Density& density, double samples, double tolerance = 2e-7) const;

 private:
  struct Rectangle {
    glm::dvec2 low, high;         // (s, phi)
    std::span<glm::dvec3> pilot;  // in it
    Rectangle half(int axis, double split, bool upper) const;
  };
  struct Node {  // of the tree of bins
    int axis = -1;  // 0 s, 1 phi, -1 a leaf
    double split = 0;
    size_t child = 0;  // the first of two; of a leaf: its bin
  };
  void divide(size_t node, const Rectangle& rectangle, size_t fewest);
  glm::dvec2 place_of(const glm::dvec3& direction) const;

  glm::dvec3 s_, t_;  // phi = 0 and a quarter turn
  mutable std::vector<glm::dvec3> pilot_;  // (s, phi, density); quadrature changes the order within a bin
  std::vector<Node> nodes_;
  std::vector<Rectangle> bins_;
};

}  // namespace tachylite::test
