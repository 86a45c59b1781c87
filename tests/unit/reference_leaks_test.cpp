// The reference's triangles at their edges: rays from inside closed meshes at edges and corners, those that the kernels
// are held to (kernels/trace_test.cpp), and others that are as near to edges as double precision allows.

#include <gtest/gtest.h>

#include "reference/geometry.h"
#include "support/edge_rays.h"
#include "unit/reference_support.h"

namespace tachylite::test {
namespace {

Scene scene_of(const TestScene& triangles, const glm::dmat4& to_world) {
  auto mesh = std::make_shared<Mesh>();
  mesh->positions.assign(triangles.vertices.begin(), triangles.vertices.end());
  mesh->triangles.assign(triangles.triangles.begin(), triangles.triangles.end());
  SceneBuilder builder;
  builder.add_shape(MeshShape{std::move(mesh)}, to_world);
  return std::move(builder.scene);
}

void expect_no_leaks(const ClosedMesh& mesh) {
  for (const RayPrecision precision : {RayPrecision::kFloat, RayPrecision::kDouble}) {
    // Turned, vertices have all bits of a double, too.
    const bool turn = precision == RayPrecision::kDouble;
    const glm::dmat4 to_world = turn ? turned(33, glm::normalize(glm::dvec3(1, 2, 3))) : glm::dmat4(1);
    const Scene scene = scene_of(mesh.room, to_world);
    const reference::Geometry geometry(scene);
    size_t missed = 0, unseen = 0;
    for_rays_at_edges(mesh, precision, 10000, [&](const std::vector<EdgeRay>& rays) {
      for (const EdgeRay& ray : rays) {
        const reference::Ray turned_ray{reference::transform_point(to_world, ray.origin),
                                        reference::transform_vector(to_world, ray.direction), ray.t_max};
        missed += !geometry.intersect(turned_ray);
        unseen += !geometry.occluded(turned_ray);
      }
    });
    EXPECT_EQ(missed, 0u) << mesh.name << (turn ? ", double" : ", float");
    EXPECT_EQ(unseen, 0u) << mesh.name << (turn ? ", double" : ", float");
  }
}

TEST(ReferenceLeaks, ClosedMeshes) {
  for (const ClosedMesh& mesh : closed_meshes()) expect_no_leaks(mesh);
}

TEST(ReferenceLeaks, ThinClosedMeshes) { expect_no_leaks(thin_closed_mesh()); }

TEST(ReferenceLeaks, TouchingBoxes) {
  for (const ClosedMesh& mesh : touching_boxes()) expect_no_leaks(mesh);
}

TEST(ReferenceLeaks, AxisParallelRaysInABox) {
  constexpr int kQuads = 6;
  const Scene scene = scene_of(tessellated_box(kQuads), glm::dmat4(1));
  const reference::Geometry geometry(scene);
  for (const EdgeRay& ray : axis_parallel_rays(kQuads)) {
    const auto hit = geometry.intersect({ray.origin, ray.direction});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->t, axis_parallel_distance(ray));
  }
}

}  // namespace
}  // namespace tachylite::test
