#include "pack/find_boxes.h"

#include <algorithm>
#include <cmath>

namespace tachylite {
namespace {

using glm::dvec3;

constexpr double kFlattest = 1e-3;  // height of a box over its edge

dvec3 centre(const Parallelogram& p) { return p.corner + 0.5 * (p.edges[0] + p.edges[1]); }

// Whether two edges are one, in either direction.
bool same_edge(const dvec3& a, const dvec3& b, double tolerance) {
  return glm::length(a - b) < tolerance || glm::length(a + b) < tolerance;
}

class BoxFinder {
 public:
  BoxFinder(std::span<const Parallelogram> all, double tolerance)
      : all_(all), tolerance_(tolerance), used_(all.size(), false) {}

  // The box with the most faces of those that are not used yet.
  Box best() const {
    Box best;
    for (size_t i = 0; i < all_.size(); ++i)
      for (size_t j = i + 1; j < all_.size(); ++j)
        if (!used_[i] && !used_[j])
          for (const std::optional<Box>& box : boxes_at(all_[i], all_[j]))
            if (box && box->face_count() > best.face_count()) best = *box;
    return best;
  }

  void use(const Box& box) {
    for (const std::optional<size_t>& face : box.faces)
      if (face) used_[*face] = true;
  }

 private:
  // Boxes that two parallelograms with an edge in common span: that edge, and the other edge of each.
  std::array<std::optional<Box>, 4> boxes_at(const Parallelogram& a, const Parallelogram& b) const {
    std::array<std::optional<Box>, 4> boxes;
    size_t found = 0;
    for (size_t k = 0; k < 2; ++k)
      for (size_t l = 0; l < 2; ++l)
        for (const double far_a : {0.0, 1.0})
          for (const double far_b : {0.0, 1.0}) {
            const dvec3 &along = a.edges[k], &along_b = b.edges[l];
            // Sides of a and b that may be one, and from there the way across each.
            const dvec3 from_a = a.corner + far_a * a.edges[1 - k], from_b = b.corner + far_b * b.edges[1 - l];
            const bool same = glm::length(from_a + 0.5 * along - from_b - 0.5 * along_b) < tolerance_ &&
                              same_edge(along, along_b, tolerance_);
            if (same && found < boxes.size())
              boxes[found++] = box_of(from_a, {along, (1 - 2 * far_a) * a.edges[1 - k], (1 - 2 * far_b) * b.edges[1 - l]});
          }
    return boxes;
  }

  std::optional<Box> box_of(const dvec3& corner, const std::array<dvec3, 3>& edges) const {
    Box box;
    const dvec3 middle = corner + 0.5 * (edges[0] + edges[1] + edges[2]);
    for (size_t k = 0; k < 3; ++k) {
      const dvec3 &u = edges[(k + 1) % 3], &v = edges[(k + 2) % 3];
      dvec3 normal = glm::normalize(glm::cross(u, v));
      const double height = glm::dot(normal, edges[k]);
      if (!(std::abs(height) > kFlattest * glm::length(edges[k]))) return std::nullopt;
      if (height < 0) normal = -normal;
      box.normals[k] = normal;
      for (size_t side = 0; side < 2; ++side) {
        const double way = static_cast<double>(side) - 0.5;
        dvec3& at = box.centres[2 * k + side];
        at = middle + way * edges[k];
        std::optional<size_t>& face = box.faces[2 * k + side];
        face = find(at, u, v);
        if (face) at = centre(all_[*face]);
      }
    }
    return box;
  }

  std::optional<size_t> find(const dvec3& middle, const dvec3& u, const dvec3& v) const {
    for (size_t i = 0; i < all_.size(); ++i) {
      const auto& [e, f] = all_[i].edges;
      if (!used_[i] && glm::length(centre(all_[i]) - middle) < tolerance_ &&
          ((same_edge(e, u, tolerance_) && same_edge(f, v, tolerance_)) ||
           (same_edge(e, v, tolerance_) && same_edge(f, u, tolerance_))))
        return i;
    }
    return std::nullopt;
  }

  std::span<const Parallelogram> all_;
  double tolerance_;
  std::vector<bool> used_;
};

}  // namespace

int Box::face_count() const {
  return static_cast<int>(std::count_if(faces.begin(), faces.end(), [](const auto& face) { return face.has_value(); }));
}

std::vector<Box> find_boxes(std::span<const Parallelogram> parallelograms, int least, double tolerance) {
  std::vector<Box> boxes;
  BoxFinder finder(parallelograms, tolerance);
  for (Box box = finder.best(); box.face_count() >= least; box = finder.best()) {
    finder.use(box);
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace tachylite
