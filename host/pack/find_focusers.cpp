#include "pack/find_focusers.h"

#include <algorithm>
#include <cmath>

namespace tachylite {
namespace {

using glm::dvec3;

constexpr size_t kMostShapes = 64;       // that are looked at
constexpr double kLargestShare = 0.7;    // of the scene's radius

struct Sphere {
  dvec3 centre;
  double radius;
};

Sphere around(const Geometry& geometry, const ShapeGeometry& shape) {
  std::vector<dvec3> points;
  for (uint32_t v = 0; v < shape.vertex_count; ++v) points.emplace_back(geometry.vertices[shape.first_vertex + v]);
  if (shape.vertex_count == 0) {
    const CurvedPrimitive& curved = geometry.curved[shape.first_primitive - geometry.triangles.size()];
    const glm::dmat4& m = curved.object_to_world;
    if (curved.kind == gpu::kLeafSphere)
      return {dvec3(m[3]), std::max({glm::length(dvec3(m[0])), glm::length(dvec3(m[1])), glm::length(dvec3(m[2]))})};
    const double height = curved.kind == gpu::kLeafCylinder ? 1 : 0;  // of the box of the unit shape
    for (int k = 0; k < 8; ++k)
      points.emplace_back(m * glm::dvec4(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? height : 0, 1));
  }
  dvec3 low = points[0], high = points[0];
  for (const dvec3& p : points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  Sphere sphere{0.5 * (low + high), 0};
  for (const dvec3& p : points) sphere.radius = std::max(sphere.radius, glm::length(p - sphere.centre));
  return sphere;
}

Sphere merge(const Sphere& a, const Sphere& b) {
  const double distance = glm::length(b.centre - a.centre);
  if (distance + b.radius <= a.radius) return a;
  if (distance + a.radius <= b.radius) return b;
  const double radius = 0.5 * (distance + a.radius + b.radius);
  return {a.centre + (b.centre - a.centre) * ((radius - a.radius) / distance), radius};
}

// Merges the two whose common sphere is the smallest.
void merge_nearest(std::vector<Sphere>& spheres) {
  size_t best_a = 0, best_b = 1;
  for (size_t a = 0; a < spheres.size(); ++a)
    for (size_t b = a + 1; b < spheres.size(); ++b)
      if (merge(spheres[a], spheres[b]).radius < merge(spheres[best_a], spheres[best_b]).radius) best_a = a, best_b = b;
  spheres[best_a] = merge(spheres[best_a], spheres[best_b]);
  spheres.erase(spheres.begin() + static_cast<std::ptrdiff_t>(best_b));
}

}  // namespace

std::vector<glm::vec4> find_focusers(const Geometry& geometry, const std::vector<uint32_t>& class_of_shape,
                                     const std::vector<MaterialClass>& classes) {
  const double largest = kLargestShare * 0.5 * glm::length(geometry.box_max - geometry.box_min);
  const auto fits = [&](const Sphere& s) { return s.radius > 0 && s.radius < largest; };
  std::vector<Sphere> spheres;
  for (size_t s = 0; s < geometry.shapes.size(); ++s) {
    if (class_of_shape[s] >= classes.size() || !can_focus(classes[class_of_shape[s]])) continue;
    if (geometry.shapes[s].primitive_count == 0) continue;
    const Sphere sphere = around(geometry, geometry.shapes[s]);
    if (fits(sphere)) spheres.push_back(sphere);
  }
  std::stable_sort(spheres.begin(), spheres.end(),
                   [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
  if (spheres.size() > kMostShapes) spheres.resize(kMostShapes);
  while (spheres.size() > gpu::kMaxFocusers) merge_nearest(spheres);
  std::erase_if(spheres, [&](const Sphere& s) { return !fits(s); });
  std::vector<glm::vec4> focusers;
  for (const Sphere& s : spheres) focusers.emplace_back(glm::vec3(s.centre), static_cast<float>(1.001 * s.radius));
  return focusers;
}

}  // namespace tachylite
