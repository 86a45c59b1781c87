#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace tachylite {

/// Points corner + s edges[0] + t edges[1], s and t in [0, 1].
struct Parallelogram {
  glm::dvec3 corner;
  std::array<glm::dvec3, 2> edges;
};

/// A parallelepiped, some of whose faces may be missing.
struct Box {
  /// Numbers of the parallelograms: faces[2 k] and faces[2 k + 1] are opposite, normals[k] points from the former to
  /// the latter (not unit).
  std::array<std::optional<size_t>, 6> faces;
  std::array<glm::dvec3, 3> normals;
  std::array<glm::dvec3, 6> centres;  // of its faces, also of those that are missing
  int face_count() const;
};

/// Boxes of at least `least` of the parallelograms each, those with the most first; no parallelogram belongs to two.
/// Corners fit within `tolerance` (length). Cubic in the number of parallelograms: for tiny scenes.
std::vector<Box> find_boxes(std::span<const Parallelogram> parallelograms, int least, double tolerance);

}  // namespace tachylite
