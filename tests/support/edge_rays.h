#pragma once

// Closed meshes and rays from inside, at their edges and corners: none may get out. For the kernels and for the
// reference alike.

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "support/bvh_scenes.h"

namespace tachylite::test {

struct ClosedMesh {
  std::string name;
  TestScene room;  // what must not leak
  TestScene aim;   // whose edges and corners rays are aimed at
  glm::dvec3 centre{0};
  double spread = 0;  // rays begin in a cube of this half width around the centre
  uint32_t seed = 0;  // of the rays
  bool in_view = false;  // nothing is seen at a grazing angle: a ray must hit where it is aimed at, or before
};

/// Bumpy spheres at three scales, and one far from the origin.
std::vector<ClosedMesh> closed_meshes();
/// One that is 1000 times as wide as high.
ClosedMesh thin_closed_mesh();
/// 26 boxes face to face around the hole that rays begin in: no single mesh closes the room. Also of corners off their
/// grid, the same for all boxes that touch there.
std::vector<ClosedMesh> touching_boxes();

struct EdgeRay {
  glm::dvec3 origin{0}, direction{0};  // every second one a unit vector
  double t_max = std::numeric_limits<double>::infinity();  // just behind the aim, where it is in view
};
/// How near rays come to edges and corners. Those of kFloat have values that are floats.
enum class RayPrecision { kFloat, kDouble };

/// Calls visit(rays) with batches of rays at points of edges, a third of them at corners: `usually` so many, or
/// TACHYLITE_EDGE_RAYS where that is set.
void for_rays_at_edges(const ClosedMesh& mesh, RayPrecision precision, size_t usually,
                       const std::function<void(const std::vector<EdgeRay>&)>& visit);

/// The cube [-1, 1]^3 of n x n quads a side.
TestScene tessellated_box(int n);
/// Axis-parallel rays from x, y or z = 0.25 of its quads' corners and points between: along edges, through corners,
/// within the planes of its faces. They hit it at 0.75 or, backwards, at 1.25.
std::vector<EdgeRay> axis_parallel_rays(int n);
double axis_parallel_distance(const EdgeRay& ray);

}  // namespace tachylite::test
