#pragma once

#include <cstdint>
#include <vector>

#include "reference/math.h"

namespace tachylite::reference {

struct Box {
  dvec3 low{kInfinity}, high{-kInfinity};
  void grow(const dvec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
  void grow(const Box& b) { low = glm::min(low, b.low), high = glm::max(high, b.high); }
  dvec3 centre() const { return 0.5 * (low + high); }
  double half_area() const {
    const dvec3 d = high - low;
    return d.x < 0 ? 0 : d.x * d.y + d.y * d.z + d.z * d.x;
  }
};

struct Ray {
  dvec3 origin, direction;  // radiance rays have unit directions, shadow rays run from t = 0 to 1
  double t_max = kInfinity;
};

/// Binary bounding volume hierarchy over boxes, split by the surface area heuristic in 16 bins (Wald 2007).
class Bvh2 {
 public:
  Bvh2() = default;
  explicit Bvh2(const std::vector<Box>& boxes);

  /// Calls visit(item, t_max), which may shorten t_max, for every item whose box the ray enters before t_max;
  /// stops when visit returns true, and returns whether it did.
  template <class Visit>
  bool traverse(const Ray& ray, const Visit& visit) const {
    if (nodes_.empty()) return false;
    double t_max = ray.t_max;
    dvec3 inverse;
    for (int k = 0; k < 3; ++k) {  // 1e-300 for 0 keeps 0 * inf = NaN out of the slabs
      const double d = ray.direction[k];
      inverse[k] = 1 / (std::abs(d) > 1e-300 ? d : std::copysign(1e-300, d));
    }
    uint32_t stack[128];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!enters(node.box, ray.origin, inverse, t_max)) continue;
      if (node.count > 0) {
        for (uint32_t i = 0; i < node.count; ++i) {
          if (visit(items_[node.first + i], t_max)) return true;
        }
        continue;
      }
      const bool backwards = ray.direction[node.axis] < 0;  // push the farther child first
      stack[depth++] = node.first + (backwards ? 0 : 1);
      stack[depth++] = node.first + (backwards ? 1 : 0);
    }
    return false;
  }

 private:
  struct Node {
    Box box;
    uint32_t first = 0;  // of two children, or of `count` items
    uint32_t count = 0;  // 0: an inner node
    int axis = 0;
  };

  /// Ize 2013, "Robust BVH Ray Traversal": the far distance is widened by the rounding of its three
  /// operations.
  static bool enters(const Box& box, const dvec3& origin, const dvec3& inverse, double t_max) {
    double near = 0, far = t_max;
    for (int k = 0; k < 3; ++k) {
      double t0 = (box.low[k] - origin[k]) * inverse[k], t1 = (box.high[k] - origin[k]) * inverse[k];
      if (t0 > t1) std::swap(t0, t1);
      t1 *= 1 + 1e-15;
      if (t0 > near) near = t0;
      if (t1 < far) far = t1;
    }
    return near <= far;
  }

  std::vector<Node> nodes_;
  std::vector<uint32_t> items_;
};

}  // namespace tachylite::reference
