// The traversal of shaders/geometry/bvh.glsl on the device, against brute force in double on the host.

#include <cmath>
#include <cstring>

#include "support/bvh_scenes.h"
#include "support/bvh_traversal.h"
#include "support/device_test.h"
#include "support/edge_rays.h"
#include "support/tracer.h"

namespace tachylite::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
using Query = Tracer::Query;
using Form = Tracer::Form;

/// What brute force says of a ray, with room for the rounding of float vertices seen from a float origin.
struct Candidate {
  double t, inside;  // inside: smallest barycentric (negative: outside); curved shapes: 1
  uint32_t primitive;
};

std::vector<Candidate> candidates(const BvhInput& input, const TraceRay& ray, double slack) {
  std::vector<Candidate> out;
  const Ray r{glm::dvec3(ray.origin), glm::dvec3(ray.direction)};
  for (size_t i = 0; i < input.triangles.size(); ++i) {
    const glm::uvec3 v = input.triangles[i];
    const glm::dvec3 a(input.vertices[v.x]), e1 = glm::dvec3(input.vertices[v.y]) - a,
        e2 = glm::dvec3(input.vertices[v.z]) - a;
    const glm::dvec3 p = cross(r.d, e2), s = r.o - a, q = cross(s, e1);
    const double det = dot(e1, p), b1 = dot(s, p) / det, b2 = dot(r.d, q) / det, t = dot(e2, q) / det;
    const double inside = std::min({b1, b2, 1 - b1 - b2});
    if (det != 0 && inside >= -slack && t > 0 && t <= ray.t_max) out.push_back({t, inside, static_cast<uint32_t>(i)});
  }
  for (size_t j = 0; j < input.curved.size(); ++j) {
    const double t = intersect_curved(r, input.curved[j]);
    if (t <= ray.t_max) out.push_back({t, 1, static_cast<uint32_t>(input.triangles.size() + j)});
  }
  return out;
}

std::vector<TraceRay> trace_rays(const std::vector<EdgeRay>& edge_rays) {
  std::vector<TraceRay> rays;
  for (const EdgeRay& ray : edge_rays)
    rays.push_back({glm::vec3(ray.origin), static_cast<float>(ray.t_max), glm::vec3(ray.direction)});
  return rays;
}

size_t count_misses(const std::vector<TraceHit>& hits) {
  size_t misses = 0;
  for (const TraceHit& hit : hits) misses += hit.id == gpu::kNoHit;
  return misses;
}

class TraceTest : public DeviceTest {
 protected:
  void build(const TestScene& scene) {
    scene_ = scene;
    bvh_ = build_bvh8(scene_.input());
    tracer_ = std::make_unique<Tracer>(device(), bvh_);
  }

  uint32_t primitive(const TraceHit& hit) const {
    return bvh_.leaves.at(hit.id / 2).info[static_cast<int>(hit.id & 1)];
  }

  /// All four kernels; they must agree bit for bit (closest) and about visibility (any).
  std::vector<TraceHit> trace(const std::vector<TraceRay>& rays) {
    std::vector<TraceHit> hits = tracer_->trace(rays, Query::kClosest);
    tracer_->run(Query::kClosest, Form::kPlain);
    const std::vector<TraceHit> plain = tracer_->hits();
    EXPECT_EQ(std::memcmp(hits.data(), plain.data(), hits.size() * sizeof hits[0]), 0);
    for (Form form : {Form::kRefill, Form::kPlain}) {
      tracer_->run(Query::kAny, form);
      const std::vector<TraceHit> any = tracer_->hits();
      size_t different = 0;
      for (size_t i = 0; i < hits.size(); ++i)
        different += (hits[i].id == gpu::kNoHit) != (any[i].id == gpu::kNoHit);
      EXPECT_EQ(different, 0u);
    }
    return hits;
  }

  /// Each hit is one of the candidates, and no candidate clearly inside a triangle lies before it.
  /// `slack`: in barycentrics; `t_slack`: relative to t and to the ray's distance scale.
  void expect_brute_force(const std::vector<TraceRay>& rays, double slack, double t_slack, double scale) {
    const std::vector<TraceHit> hits = trace(rays);
    size_t found = 0, wrong = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const auto list = candidates(scene_.input(), rays[i], slack);
      const bool hit = hits[i].id != gpu::kNoHit;
      found += hit;
      bool known = !hit;
      double nearest = std::numeric_limits<double>::infinity();
      for (const Candidate& c : list) {
        const double tolerance = t_slack * (c.t + scale);
        if (c.inside > slack) nearest = std::min(nearest, c.t + tolerance);
        known |= hit && c.primitive == primitive(hits[i]) && std::abs(c.t - hits[i].t) <= tolerance;
      }
      wrong += !known || (hit ? hits[i].t : kInfinity) > nearest;
    }
    EXPECT_EQ(wrong, 0u) << "of " << rays.size();
    EXPECT_GT(found, rays.size() / 20);
    EXPECT_LT(found, rays.size() + 1);
  }

  void expect_no_leaks(const ClosedMesh& mesh) {
    build(mesh.room);
    size_t leaks = 0;
    for_rays_at_edges(mesh, RayPrecision::kFloat, 60000,
                      [&](const auto& rays) { leaks += count_misses(trace(trace_rays(rays))); });
    EXPECT_EQ(leaks, 0u) << mesh.name;
  }

  TestScene scene_;
  Bvh8 bvh_;
  std::unique_ptr<Tracer> tracer_;
};

std::vector<TraceRay> random_rays(size_t count, double half, uint32_t seed) {
  RandomPlaces random(seed);
  std::vector<TraceRay> rays(count);
  for (TraceRay& ray : rays) {
    ray.origin = glm::vec3(random.in_cube(half));
    ray.direction = glm::vec3(random.direction());
    ray.t_max = random.uniform() < 0.3 ? static_cast<float>(half * random.uniform()) : kInfinity;
  }
  return rays;
}

TEST_F(TraceTest, TriangleSoup) {
  build(triangle_soup(1500, .15, 1));
  expect_brute_force(random_rays(4000, 1.5, 2), 1e-4, 1e-5, 1);
}

TEST_F(TraceTest, HugeNextToTiny) {
  build(huge_and_tiny(600, 3));
  // Vertices of size 1e3 have edges that are exact to 1e-4 only.
  expect_brute_force(random_rays(3000, 1, 4), 1e-3, 1e-4, 1);
}

TEST_F(TraceTest, Scales) {
  for (double scale : {1e-4, 1e-2, 1e3, 1e6}) {
    TestScene scene = triangle_soup(300, .2, 5);
    for (glm::vec3& v : scene.vertices) v *= static_cast<float>(scale);
    build(scene);
    expect_brute_force(random_rays(1500, 1.5 * scale, 6), 1e-4, 1e-5, scale);
  }
}

TEST_F(TraceTest, CurvedAlone) {
  TestScene scene;
  add_curved(scene, 200, 7);
  build(scene);
  expect_brute_force(random_rays(3000, 1.5, 8), 1e-4, 3e-4, 1);
}

TEST_F(TraceTest, CurvedAmongTriangles) {
  TestScene scene = triangle_soup(300, .1, 9);
  add_curved(scene, 150, 10);
  build(scene);
  expect_brute_force(random_rays(3000, 1.5, 11), 1e-4, 3e-4, 1);
}

TEST_F(TraceTest, ClosedMeshesDoNotLeak) {
  for (const ClosedMesh& mesh : closed_meshes()) expect_no_leaks(mesh);
}

TEST_F(TraceTest, ThinClosedMeshesDoNotLeak) { expect_no_leaks(thin_closed_mesh()); }

TEST_F(TraceTest, TouchingBoxesDoNotLeak) {
  for (const ClosedMesh& mesh : touching_boxes()) expect_no_leaks(mesh);
}

TEST_F(TraceTest, AxisParallelRaysInABox) {
  constexpr int kQuads = 6;
  build(tessellated_box(kQuads));
  const std::vector<EdgeRay> rays = axis_parallel_rays(kQuads);
  const std::vector<TraceHit> hits = trace(trace_rays(rays));
  ASSERT_EQ(count_misses(hits), 0u);
  for (size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(hits[i].t, axis_parallel_distance(rays[i]));
}

TEST_F(TraceTest, TheIgnoredTriangleDoesNotCount) {
  build(bumpy_sphere(20, 40, .1, 16));
  std::vector<TraceRay> rays = random_rays(5000, .3, 17);
  for (TraceRay& ray : rays) ray.t_max = kInfinity;
  const std::vector<TraceHit> before = trace(rays);
  ASSERT_EQ(count_misses(before), 0u);
  for (size_t i = 0; i < rays.size(); ++i) rays[i].ignore = before[i].id;
  const std::vector<TraceHit> after = trace(rays);
  for (size_t i = 0; i < rays.size(); ++i) EXPECT_NE(after[i].id, before[i].id);
  EXPECT_GT(count_misses(after), rays.size() / 2);
}

/// Barycentrics in the leaf's order of vertices give the point that t gives.
TEST_F(TraceTest, BarycentricsAgreeWithDistance) {
  build(triangle_soup(500, .3, 18));
  const std::vector<TraceRay> rays = random_rays(3000, 1, 19);
  const std::vector<TraceHit> hits = trace(rays);
  for (size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].id == gpu::kNoHit) continue;
    const auto v = leaf_vertices(bvh_, hits[i].id / 2);
    const size_t second = hits[i].id & 1;
    const glm::dvec3 v0(v[0]), v1(v[1 + second]), v2(v[2 + second]);
    const glm::dvec3 p = v0 + double{hits[i].b1} * (v1 - v0) + double{hits[i].b2} * (v2 - v0);
    const glm::dvec3 q = glm::dvec3(rays[i].origin) + double{hits[i].t} * glm::dvec3(rays[i].direction);
    // Seen at a grazing angle, a shift of the ray by rounding moves both along the triangle.
    const glm::dvec3 n = glm::normalize(glm::cross(v1 - v0, v2 - v0));
    const double cosine = std::abs(glm::dot(n, glm::dvec3(rays[i].direction)));
    EXPECT_LT(glm::length(p - q), 2e-6 / std::max(cosine, 1e-4));
  }
}

TEST_F(TraceTest, NothingToHit) {
  build(TestScene{});
  const std::vector<TraceRay> rays = random_rays(200, 1, 20);
  EXPECT_EQ(count_misses(trace(rays)), rays.size());
}

/// Numbers of rays around the sizes of subgroups and workgroups.
TEST_F(TraceTest, AnyNumberOfRays) {
  build(bumpy_sphere(10, 20, .1, 21));
  for (size_t count : {1, 7, 8, 9, 63, 64, 65, 1023, 1024, 1025, 3000}) {
    std::vector<TraceRay> rays = random_rays(count, .3, 22);
    for (TraceRay& ray : rays) ray.t_max = kInfinity;
    EXPECT_EQ(count_misses(trace(rays)), 0u) << count;
  }
}

/// Spheres far away, tiny and huge: t to a few units in the last place of the distances involved.
TEST_F(TraceTest, SpheresOfAllSizes) {
  RandomPlaces random(23);
  for (const auto& [radius, distance] : {std::pair{1.0, 3.0}, {1e-3, 10.0}, {1e5, 1e5 + 10}, {1.0, 2000.0}}) {
    TestScene scene;
    const glm::dmat4 to_world = glm::scale(glm::dmat4(1), glm::dvec3(radius));
    scene.curved.push_back({gpu::kLeafSphere, to_world});
    build(scene);
    std::vector<TraceRay> rays(2000);
    for (TraceRay& ray : rays) {
      const glm::dvec3 o = distance * random.direction(), target = 0.8 * radius * random.direction();
      ray = {glm::vec3(o), kInfinity, glm::vec3(glm::normalize(target - o)), gpu::kNoHit};
    }
    const std::vector<TraceHit> hits = trace(rays);
    for (size_t i = 0; i < rays.size(); ++i) {
      ASSERT_NE(hits[i].id, gpu::kNoHit);
      const Ray ray{glm::dvec3(rays[i].origin), glm::dvec3(rays[i].direction)};
      EXPECT_NEAR(hits[i].t, intersect_curved(ray, scene.curved[0]), 2e-6 * distance) << radius;
    }
  }
}

}  // namespace
}  // namespace tachylite::test
