// Choosing among lights, in the loop and in the tree: the irradiance of many lights is the sum of closed forms, the
// probability that a hit finds is the one that the sample had, and lights that shine on a point are never left out.
//
// The z-tests have a level of 1e-5 each; the standard error is required to be below 1 %, so that a bias of 6.5 % of
// all light is seen with a power of 0.98, and one of a single light where it dominates.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/pi.h"
#include "shared/features.h"
#include "shared/light.h"
#include "statistics/light_harness.h"

namespace tachylite::test {
namespace {

using glm::dvec2;
using glm::dvec3;
constexpr size_t kSamples = 100000;

/// Lambert's formula for a polygon with all corners above the horizon, radiance 1.
double polygon_irradiance(std::span<const dvec3> corners, const dvec3& p, const dvec3& n) {
  double sum = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const dvec3 a = corners[i] - p, b = corners[(i + 1) % corners.size()] - p, c = glm::cross(a, b);
    sum += std::atan2(glm::length(c), glm::dot(a, b)) * glm::dot(glm::normalize(c), n);
  }
  return 0.5 * std::abs(sum);
}

/// `count` small triangles over the floor z = 0, facing down, of powers over six decades.
struct TriangleField {
  Scene scene;
  std::vector<std::array<dvec3, 3>> triangles;
  std::vector<double> radiance;

  explicit TriangleField(int count, uint32_t seed) {
    Uniform u(seed);
    for (int i = 0; i < count; ++i) {
      auto mesh = std::make_shared<Mesh>();
      const glm::vec3 c(20 * u() - 10, 20 * u() - 10, 0.5f + 4 * u());
      const float size = 0.02f + 0.2f * u();
      // Clockwise from above: the normal points down.
      mesh->positions = {c, c + size * glm::vec3(0.3f * u(), 1, 0.2f * u()), c + size * glm::vec3(1, 0.3f * u(), 0.2f * u())};
      mesh->triangles = {{0, 1, 2}};
      triangles.push_back({dvec3(mesh->positions[0]), dvec3(mesh->positions[1]), dvec3(mesh->positions[2])});
      radiance.push_back(std::pow(10.0, 6 * u() - 3));
      const int shape = add_shape(scene, MeshShape{mesh}, glm::dmat4(1));
      add_area_light(scene, shape, dvec3(radiance.back()));
    }
  }
  double irradiance(const dvec3& p) const {
    double sum = 0;
    for (size_t i = 0; i < triangles.size(); ++i) {
      const auto& t = triangles[i];
      const bool faces = glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), p - t[0]) > 0;  // they tilt a little
      if (faces) sum += radiance[i] * polygon_irradiance(t, p, {0, 0, 1});
    }
    return sum;
  }
};

/// Mean and standard error of the irradiance on a surface at p with normal n.
dvec2 irradiance(const std::vector<LightAnswer>& answers, const dvec3& n) {
  double sum = 0, squares = 0;
  for (const LightAnswer& a : answers) {
    const double cosine = std::max(0.0, glm::dot(n, dvec3(a.wi)));
    const double value = a.pdf > 0 ? double{a.radiance.x} * cosine / double{a.pdf} : 0;
    sum += value;
    squares += value * value;
  }
  const double count = double(answers.size()), mean = sum / count;
  return {mean, std::sqrt((squares / count - mean * mean) / count)};
}

std::vector<LightQuery> queries_at(const glm::vec3& p, uint32_t seed, size_t count = kSamples) {
  Uniform uniform(seed);
  std::vector<LightQuery> queries(count);
  for (LightQuery& q : queries) q = {p, {0, 0, 0}, uniform.two(), uniform()};
  return queries;
}

class LightSelection : public DeviceTest {};

TEST_F(LightSelection, FieldsOfTrianglesAddUp) {
  uint32_t seed = 1;
  for (const int count : {1, 2, 16, 17, 1000}) {
    const TriangleField field(count, 77);
    LightHarness harness(field.scene);
    EXPECT_EQ(harness.lights().selection, count == 1    ? gpu::kSelectSingle
                                          : count <= 16 ? gpu::kSelectLoop
                                                        : gpu::kSelectTree);
    for (const dvec3& p : {dvec3(0, 0, 0), dvec3(7, -4, 0), dvec3(-30, 40, 0)}) {
      SCOPED_TRACE(fmt::format("{} lights from ({}, {})", count, p.x, p.y));
      const double exact = field.irradiance(p);
      std::vector<LightQuery> queries = queries_at(glm::vec3(p - harness.centre()), seed++);
      if (p.x == 7)
        for (LightQuery& q : queries) q.n = {0, 0, 1};
      const dvec2 e = irradiance(harness.sample(queries), {0, 0, 1});
      EXPECT_LT(e.y, 0.01 * exact);
      EXPECT_NEAR(e.x, exact, 4.42 * e.y);
    }
  }
}

TEST_F(LightSelection, HitsFindTheProbabilityOfTheSample) {
  for (const int count : {3, 16, 17, 3000}) {
    const TriangleField field(count, 5);
    LightHarness harness(field.scene);
    Uniform u(9);
    std::vector<LightQuery> queries = queries_at({}, 11, 3000);
    for (LightQuery& q : queries) {
      q.p = glm::vec3(dvec3(24 * u() - 12, 24 * u() - 12, 0) - harness.centre());
      const glm::vec3 n(u() - 0.5f, u() - 0.5f, u() - 0.5f);
      q.n = u() < 0.5f ? glm::vec3(0) : glm::normalize(n);
    }
    const std::vector<LightAnswer> answers = harness.sample(queries);
    std::vector<LightHit> hits;
    std::vector<float> densities;
    for (size_t i = 0; i < answers.size(); ++i) {
      const LightAnswer& a = answers[i];
      if (a.pdf == 0) continue;
      LightHit hit;
      hit.p = queries[i].p;
      hit.d = a.wi;
      hit.t = glm::length(a.to_light);
      hit.key = a.key;
      hit.primitive = harness.primitive_of(a.target);
      hit.shape = harness.shape_of(hit.primitive);
      hits.push_back(hit);
      densities.push_back(a.pdf);
    }
    EXPECT_GT(hits.size(), 2000u);  // some surfaces see no light
    const std::vector<LightValue> values = harness.evaluate(hits);
    for (size_t i = 0; i < values.size(); ++i) ASSERT_NEAR(values[i].pdf / densities[i], 1, 2e-4) << count << ", " << i;
  }
}

TEST_F(LightSelection, AllKindsTogether) {
  // A lamp of each kind over a floor at the origin, and a sun; the exact irradiance is a sum of closed forms.
  const auto scene_with = [](int fillers) {
    Scene scene;
    const int rectangle = add_shape(scene, RectangleShape{}, placed({3, 0, 2}, {0.5, 0.5, 1}, {1, 0, 0}, 180));
    add_area_light(scene, rectangle, dvec3(4));
    const int sphere = add_shape(scene, SphereShape{{-2, 1, 2}, 0.4}, glm::dmat4(1));
    add_area_light(scene, sphere, dvec3(3));
    const int disk = add_shape(scene, DiskShape{}, placed({0, 0, 3}, dvec3(0.6), {1, 0, 0}, 180));
    add_area_light(scene, disk, dvec3(2));
    add_emitter(scene, PointEmitter{{1, -2, 2}, dvec3(5)});
    add_emitter(scene, DirectionalEmitter{glm::normalize(dvec3(1, 1, -3)), dvec3(0.7)});
    // A spot that lights the origin at full strength, and one whose beam misses it.
    const glm::dmat4 down = placed({0, 0, 2.5}, dvec3(1), {1, 0, 0}, 180);
    add_emitter(scene, SpotEmitter{down, dvec3(3), 0.5, 0.3, kNone});
    add_emitter(scene, SpotEmitter{placed({0, 4, 2}, dvec3(1), {1, 0, 0}, 180), dvec3(1000), 0.5, 0.3, kNone});
    // Lights that shine away from the floor, to fill a tree.
    for (int i = 0; i < fillers; ++i) {
      const int up = add_shape(scene, RectangleShape{}, placed({0.4 * i, 5, 0.5}, dvec3(0.1)));
      add_area_light(scene, up, dvec3(50));
    }
    return scene;
  };
  const std::array<dvec3, 4> corners{dvec3(2.5, -0.5, 2), dvec3(3.5, -0.5, 2), dvec3(3.5, 0.5, 2), dvec3(2.5, 0.5, 2)};
  const double point = 5 * 2 / std::pow(1.0 + 4 + 4, 1.5), spot = 3 / (2.5 * 2.5);
  const double exact = 4 * polygon_irradiance(corners, {0, 0, 0}, {0, 0, 1}) +
                       3 * kPi * 0.16 / 9 * (2 / 3.0) +  // sphere: pi L (r/d)^2 cos
                       2 * kPi * 0.36 / 9.36 + point + spot + 0.7 * 3 / std::sqrt(11.0);
  for (const int fillers : {0, 60}) {
    LightHarness harness(scene_with(fillers));
    const glm::vec3 p(-harness.centre());
    const std::vector<LightAnswer> answers = harness.sample(queries_at(p, 31));
    const dvec2 e = irradiance(answers, {0, 0, 1});
    EXPECT_LT(e.y, 0.005 * exact);
    EXPECT_NEAR(e.x, exact, 4.42 * e.y) << fillers;
    // No sample goes to what cannot shine here: the importance is 0 (but for the sphere around a light's box).
    size_t wasted = 0;
    for (const LightAnswer& a : answers) wasted += a.pdf == 0 || a.radiance == glm::vec3(0);
    EXPECT_LT(wasted, answers.size() / 25) << fillers;
  }
}

TEST_F(LightSelection, SmoothMeshesShineByTheirVertexNormals) {
  // An octahedron with the normals of a sphere: by quadrature over its faces, where the interpolated normal looks at
  // the point; that normal also converts area to solid angle, as in Mitsuba.
  auto mesh = std::make_shared<Mesh>();
  mesh->positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh->normals = mesh->positions;
  mesh->triangles = {{4, 0, 2}, {0, 5, 2}, {5, 1, 2}, {1, 4, 2}, {0, 4, 3}, {5, 0, 3}, {1, 5, 3}, {4, 1, 3}};
  Scene scene;
  add_shape(scene, MeshShape{mesh}, glm::dmat4(1));
  add_area_light(scene, 0, dvec3(1));
  LightHarness harness(scene);
  EXPECT_NE(harness.lights().kinds & (1u << gpu::kLightsSmooth), 0u);
  const dvec3 p(2, 0.5, -0.3), n = glm::normalize(-p);
  double exact = 0;
  constexpr int kSteps = 400;
  for (const glm::uvec3& t : mesh->triangles) {
    const dvec3 v0(mesh->positions[t.x]), e1 = dvec3(mesh->positions[t.y]) - v0, e2 = dvec3(mesh->positions[t.z]) - v0;
    const dvec3 area = glm::cross(e1, e2);
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps - i; ++j) {
        // Midpoints of the two halves of each small square (one on the diagonal).
        for (int half = 0; half < (i + j == kSteps - 1 ? 1 : 2); ++half) {
          const double third = half == 0 ? 1 / 3.0 : 2 / 3.0, b1 = (i + third) / kSteps, b2 = (j + third) / kSteps;
          const dvec3 x = v0 + b1 * e1 + b2 * e2, to = x - p;
          const double d2 = glm::dot(to, to);
          if (glm::dot(x, to) >= 0) continue;  // the interpolated normal is x itself
          const double projected = glm::length(area) * std::abs(glm::dot(glm::normalize(x), to));
          exact += 0.5 * projected / (kSteps * kSteps) * std::max(0.0, glm::dot(n, to)) / (d2 * d2);
        }
      }
  }
  const dvec2 e = irradiance(harness.sample(queries_at(glm::vec3(p - harness.centre()), 41, 400000)), n);
  EXPECT_LT(e.y, 0.005 * exact);
  EXPECT_NEAR(e.x, exact, 4.42 * e.y + 1e-3 * exact);
}

}  // namespace
}  // namespace tachylite::test
