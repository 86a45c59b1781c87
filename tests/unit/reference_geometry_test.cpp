// Rays against shapes of the reference: hits, frames, uv, sampling of areas, and no self-intersection at any
// scale.

#include <gtest/gtest.h>

#include "reference/analytic_shape.h"
#include "reference/geometry.h"
#include "support/chi2.h"
#include "unit/reference_support.h"

namespace tachylite {
namespace {

using namespace reference;
using namespace test;

std::shared_ptr<Mesh> random_triangles(int count, Random& random) {
  auto mesh = std::make_shared<Mesh>();
  for (int i = 0; i < count; ++i) {
    const dvec3 centre = 10.0 * dvec3(random.uniform(), random.uniform(), random.uniform());
    for (int k = 0; k < 3; ++k) {
      mesh->positions.emplace_back(centre + sample_sphere(random.uniform2()));
      mesh->uvs.emplace_back(random.uniform(), random.uniform());
      mesh->normals.emplace_back(sample_sphere(random.uniform2()));
    }
    const auto first = static_cast<uint32_t>(3 * i);
    mesh->triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

/// Every kind of shape, under a rotation, an anisotropic scale (not for the sphere) and a shift.
SceneBuilder all_shapes(double size) {
  SceneBuilder b;
  Random random(4, 0, 0);
  const dmat4 place = scaled(dvec3(size)) * turned(35, glm::normalize(dvec3(1, 2, 3)));
  b.add_shape(SphereShape{{0.5, 0, 0}, 0.8}, place);
  b.add_shape(RectangleShape{}, place * moved({3, 0, 0}) * scaled({1, 0.5, 1}));
  b.add_shape(DiskShape{}, place * moved({0, 3, 0}) * scaled({0.5, 1, 1}));
  b.add_shape(CubeShape{}, place * moved({0, 0, 3}) * scaled({1, 0.3, 0.7}));
  b.add_shape(CylinderShape{{-3, 0, 0}, {-3, 1, 1}, 0.4}, place);
  b.add_shape(MeshShape{random_triangles(50, random)}, place * moved({-5, -14, -5}));
  return b;
}

Ray random_ray(double size, Random& random) {
  const dvec3 from = 20 * size * sample_sphere(random.uniform2());
  const dvec3 at = size * (12.0 * dvec3(random.uniform(), random.uniform(), random.uniform()) - 6.0);
  return {from, glm::normalize(at - from)};
}

/// The tree must find what a loop over all boxes finds.
TEST(ReferenceGeometry, TreeFindsTheNearestOfAllBoxes) {
  Random random(1, 0, 0);
  for (const int count : {0, 1, 2, 9, 500}) {
    std::vector<Box> boxes;
    for (int i = 0; i < count; ++i) {
      Box box;
      box.grow(10.0 * dvec3(random.uniform(), random.uniform(), i % 3 == 0 ? 0.5 : random.uniform()));
      box.grow(box.low + dvec3(random.uniform(), i % 5 == 0 ? 0 : random.uniform(), random.uniform()));
      boxes.push_back(box);
    }
    const Bvh2 bvh(boxes);
    for (int i = 0; i < 300; ++i) {
      Ray ray = random_ray(1, random);
      if (i % 7 == 0) ray = {{random.uniform() * 10, random.uniform() * 10, -1}, {0, 0, 1}};
      const auto entry = [&](const Box& box) {  // distance to the box, or infinity
        double near = 0, far = kInfinity;
        for (int k = 0; k < 3; ++k) {
          if (ray.direction[k] == 0) {
            if (ray.origin[k] < box.low[k] || ray.origin[k] > box.high[k]) return kInfinity;
            continue;
          }
          const double a = (box.low[k] - ray.origin[k]) / ray.direction[k];
          const double c = (box.high[k] - ray.origin[k]) / ray.direction[k];
          near = std::max(near, std::min(a, c));
          far = std::min(far, std::max(a, c));
        }
        return near <= far ? near : kInfinity;
      };
      double expected = kInfinity, found = kInfinity;
      for (const Box& box : boxes) expected = std::min(expected, entry(box));
      bvh.traverse(ray, [&](uint32_t item, double& t_max) {
        found = std::min(found, entry(boxes[item]));
        t_max = found;
        return false;
      });
      EXPECT_EQ(found, expected);
    }
  }
}

/// Points, normals and derivatives of all shapes: p on the ray, dp_du and dp_dv as differences of p over uv,
/// normals perpendicular to them. Spheres and cylinders have curvature, hence the tolerance of the
/// differences.
TEST(ReferenceGeometry, HitsAreOnTheRayAndDerivativesMatchDifferences) {
  const SceneBuilder b = all_shapes(1);
  const Geometry geometry(b.scene);
  Random random(2, 0, 0);
  std::vector<int> hits(b.scene.shapes.size());
  for (int i = 0; i < 20000; ++i) {
    const Ray ray = random_ray(1, random);
    const auto hit = geometry.intersect(ray);
    EXPECT_EQ(geometry.occluded(ray), hit.has_value());
    if (!hit) continue;
    ++hits[static_cast<size_t>(hit->shape)];
    EXPECT_LT(glm::distance(hit->p, ray.origin + hit->t * ray.direction), 1e-12);
    const Frame& f = hit->frame;
    EXPECT_NEAR(glm::length(hit->n_g), 1, 1e-12);
    EXPECT_NEAR(glm::dot(f.s, f.t), 0, 1e-9);
    EXPECT_LT(glm::distance(glm::cross(f.s, f.t), f.n), 1e-9);
    EXPECT_NEAR(glm::dot(hit->n_g, glm::normalize(hit->dp_du)), 0, 1e-9);
    EXPECT_NEAR(glm::dot(hit->n_g, glm::normalize(hit->dp_dv)), 0, 1e-9);

    // A neighbouring hit: its displacement is what its uv says.
    const dvec3 other_at = hit->p + 1e-6 * sample_sphere(random.uniform2());
    const auto other = geometry.intersect({ray.origin, glm::normalize(other_at - ray.origin)});
    const bool same = other && other->shape == hit->shape && other->at.triangle == hit->at.triangle;
    const bool disk = std::holds_alternative<DiskShape>(b.scene.shapes[static_cast<size_t>(hit->shape)].kind);
    const dvec2 duv = same ? other->at.uv - hit->at.uv : dvec2(1);
    if (!same || disk || glm::length(duv) > 0.1)
      continue;  // an edge; Mitsuba's disk has a dp_dv of its own; the seam
    const dvec3 dp = duv.x * hit->dp_du + duv.y * hit->dp_dv;
    const double cosine = std::abs(glm::dot(ray.direction, hit->n_g));
    EXPECT_LT(glm::distance(dp, other->p - hit->p), 1e-3 * 1e-6 / cosine) << hit->shape;
  }
  for (const int n : hits) EXPECT_GT(n, 100);
}

TEST(ReferenceGeometry, ParametersOfTheUnitShapes) {
  const auto at = [](const auto& kind, const dvec3& p) {
    Shape shape;
    shape.kind = kind;
    return unit_shape_point(shape, p);
  };
  EXPECT_EQ(at(RectangleShape{}, {-1, 0.5, 0}).uv, dvec2(0, 0.75));
  EXPECT_LT(glm::distance(at(SphereShape{}, {0, -1, 0}).uv, dvec2(0.75, 0.5)), 1e-15);
  EXPECT_LT(glm::distance(at(SphereShape{}, {0, 0, 1}).uv, dvec2(0, 0)), 1e-15);
  EXPECT_LT(glm::distance(at(DiskShape{}, {0, 0.5, 0}).uv, dvec2(0.5, 0.25)), 1e-15);
  EXPECT_LT(glm::distance(at(CylinderShape{}, {-1, 0, 0.3}).uv, dvec2(0.5, 0.3)), 1e-15);

  // The cube: outward normals, six faces of [0,1]^2.
  const auto cube = make_cube_mesh();
  ASSERT_EQ(cube->triangles.size(), 12u);
  for (const glm::uvec3& t : cube->triangles) {
    const dvec3 a = cube->positions[t.x], b = cube->positions[t.y], c = cube->positions[t.z];
    EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a + b + c), 0);
    const dvec2 u = cube->uvs[t.x], v = cube->uvs[t.y], w = cube->uvs[t.z];
    EXPECT_EQ(std::abs((v - u).x * (w - u).y - (v - u).y * (w - u).x), 1);
  }
}

TEST(ReferenceGeometry, NormalsFlipAndInterpolate) {
  SceneBuilder b;
  auto mesh = std::make_shared<Mesh>();
  mesh->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh->normals = {{0, 0, 1}, {1, 0, 1}, {0, 0, 1}};
  mesh->triangles = {{0, 1, 2}};
  const int smooth = b.add_shape(MeshShape{mesh});
  const int flipped = b.add_shape(MeshShape{mesh}, moved({0, 0, 1}));
  const int flat = b.add_shape(MeshShape{mesh}, moved({0, 0, 2}));
  b.add_shape(MeshShape{mesh}, moved({0, 0, 3}) * scaled({1, 1, 0.5}));
  b.scene.shapes[static_cast<size_t>(flipped)].flip_normals = true;
  b.scene.shapes[static_cast<size_t>(flat)].face_normals = true;
  const Geometry geometry(b.scene);
  const auto hit = [&](double z) { return *geometry.intersect({{0.5, 0.25, z}, {0, 0, -1}}); };
  // Unit in world space, then interpolated.
  const dvec3 n = glm::normalize(dvec3(0, 0, 0.5) + 0.5 * glm::normalize(dvec3(1, 0, 1)));
  const dvec3 scaled_n = glm::normalize(dvec3(0, 0, 0.5) + 0.5 * glm::normalize(dvec3(1, 0, 2)));
  EXPECT_LT(glm::distance(hit(3.5).frame.n, scaled_n), 1e-7);
  EXPECT_EQ(hit(0.5).shape, smooth);
  EXPECT_LT(glm::distance(hit(0.5).frame.n, n), 1e-7);
  EXPECT_EQ(hit(0.5).n_g, dvec3(0, 0, 1));
  EXPECT_LT(glm::distance(hit(1.5).frame.n, -n), 1e-7);
  EXPECT_EQ(hit(1.5).n_g, dvec3(0, 0, -1));
  EXPECT_EQ(hit(2.5).frame.n, dvec3(0, 0, 1));
  EXPECT_EQ(hit(0.5).at.uv, dvec2(0.5, 0.25));  // no uv: barycentrics
}

/// From a point of a plane or a sphere, rays out never meet it again, and rays into the sphere meet it once:
/// at scales from 1e-6 to 1e9, at grazing angles, and far from the origin.
TEST(ReferenceGeometry, RaysLeaveTheirSurfaceAtAnyScale) {
  Random random(3, 0, 0);
  for (const double size : {1e-6, 1.0, 1e4, 1e9}) {
    for (const double shift : {0.0, 1e3}) {
      SceneBuilder b;
      const dmat4 place = scaled(dvec3(size)) * moved(dvec3(shift, -shift, shift)) * turned(33, {0, 1, 0});
      b.add_shape(SphereShape{}, place);
      b.add_shape(RectangleShape{}, place * moved({4, 0, 0}));
      b.add_shape(CubeShape{}, place * moved({-4, 0, 0}));
      b.add_shape(CylinderShape{{0, 4, 0}, {0, 6, 0}, 0.5}, place);
      const Geometry geometry(b.scene);
      for (int shape = 0; shape < 4; ++shape) {
        for (int i = 0; i < 2000; ++i) {
          const SurfacePoint p = geometry.sample_area(shape, random).point;
          const double grazing = std::pow(10.0, -6 * random.uniform());
          const double phi = 2 * kPi * random.uniform();
          const Frame f = frame_around(p.n_g);
          const dvec3 out = glm::normalize(f.to_world({std::cos(phi), std::sin(phi), grazing}));
          const auto again = geometry.intersect(p.spawn_ray(out));
          EXPECT_TRUE(!again || again->shape != shape) << shape << " " << size << " " << grazing;
          if (shape == 0) {
            const auto through = geometry.intersect(p.spawn_ray(-out));
            ASSERT_TRUE(through) << size << " " << shift << " " << grazing;
            // The chord of a sphere: 2 r cos; the offset deepens it by its length over the slope.
            const double chord = 2 * size * grazing / std::sqrt(1 + grazing * grazing);
            EXPECT_NEAR(through->t, chord, 2 * p.error / grazing) << size << " " << shift;
            EXPECT_FALSE(geometry.intersect(through->spawn_ray(-out)) &&
                         geometry.intersect(through->spawn_ray(-out))->shape == 0);
          }
        }
      }
    }
  }
}

/// Area, and its uniform sampling: points of a sphere and a disk, triangles of a mesh. Level 0.01 over the
/// three.
TEST(ReferenceGeometry, SamplesAreasUniformly) {
  Random random(6, 0, 0);
  SceneBuilder b;
  const int sphere = b.add_shape(SphereShape{{0, 0, 0}, 2});
  const int disk = b.add_shape(DiskShape{}, scaled({2, 3, 1}));
  auto mesh = random_triangles(20, random);
  const int triangles = b.add_shape(MeshShape{mesh});
  const int cylinder = b.add_shape(CylinderShape{{0, 0, 0}, {0, 0, 3}, 0.5});
  const int cube = b.add_shape(CubeShape{}, scaled(dvec3(0.5)));
  const Geometry geometry(b.scene);
  EXPECT_NEAR(geometry.area(sphere), 16 * kPi, 1e-12);
  EXPECT_NEAR(geometry.area(disk), 6 * kPi, 1e-12);
  EXPECT_NEAR(geometry.area(cylinder), 3 * kPi, 1e-12);
  EXPECT_NEAR(geometry.area(cube), 6, 1e-12);

  constexpr int kSamples = 20000;
  std::vector<glm::dvec2> on_sphere, on_disk;
  std::vector<double> counts(20), expected(20);
  for (int i = 0; i < kSamples; ++i) {
    const dvec3 s = geometry.sample_area(sphere, random).point.p / 2.0;
    on_sphere.emplace_back(0.5 * (1 + s.z) * (1 - 1e-12),
                           0.5 + std::atan2(s.y, s.x) / (2 * kPi) * (1 - 1e-12));
    const dvec3 d = geometry.sample_area(disk, random).point.p / dvec3(2, 3, 1);
    on_disk.emplace_back(std::min(d.x * d.x + d.y * d.y, 1 - 1e-12),
                         0.5 + std::atan2(d.y, d.x) / (2 * kPi) * (1 - 1e-12));
    counts[geometry.sample_area(triangles, random).point.at.triangle] += 1;
  }
  for (size_t i = 0; i < 20; ++i) {
    const dvec3 a = mesh->positions[3 * i], e = mesh->positions[3 * i + 1], c = mesh->positions[3 * i + 2];
    expected[i] = kSamples * 0.5 * glm::length(glm::cross(e - a, c - a)) / geometry.area(triangles);
  }
  const double level = sidak(0.01, 3);
  for (const auto& result :
       {chi2_test_uniform_square(on_sphere, 16, level), chi2_test_uniform_square(on_disk, 16, level),
        chi2_test(counts, expected, level)}) {
    EXPECT_TRUE(result.accepted) << result.message;
  }
}

}  // namespace
}  // namespace tachylite
