// Area lights: samples follow their densities (chi2 in the light's own coordinates), both sides of MIS see the same
// density, and irradiance agrees with closed forms.
//
// Each chi2 test draws 1e5 samples into 256 bins; all of them together have a level of 1 %. A single one sees a
// relative deviation of the density of about 4 % (rms over the bins) with a power of 0.99 (see its message). The
// z-tests of the irradiance have a level of 1e-5 each and see a bias of 6.5 standard errors with a power of 0.98;
// the standard error is required to be below 0.5 %.

#include <cmath>
#include <functional>
#include <string>

#include <fmt/format.h>

#include "base/pi.h"
#include "shared/features.h"
#include "statistics/light_harness.h"
#include "support/chi2.h"

namespace tachylite::test {
namespace {

using glm::dvec2;
using glm::dvec3;
constexpr int kBins = 16, kOrder = 5, kChi2Tests = 32;
constexpr size_t kSamples = 100000;

/// A light, points that see it, and coordinates (s, t) in [0, 1]^2 on it.
struct LightCase {
  std::string name;
  decltype(Shape::kind) kind;
  glm::dmat4 to_world{1};
  bool flip = false;
  std::vector<dvec3> points;
  /// World-space point at (s, t) and its normal times d area / (ds dt); as seen from p.
  std::function<std::pair<dvec3, dvec3>(const glm::dmat4& m, const dvec3& p, dvec2 st)> at;
  std::function<dvec2(const glm::dmat4& m, const dvec3& p, const dvec3& x)> inverse;
};

std::shared_ptr<const Mesh> triangle_mesh() {
  auto mesh = std::make_shared<Mesh>();
  mesh->positions = {{0, 0, 0}, {1, 0.2f, 0}, {0.3f, 1.4f, 0}};
  mesh->triangles = {{0, 1, 2}};
  return mesh;
}

dvec3 point_of(const glm::dmat4& m, const dvec3& q) { return dvec3(m * glm::dvec4(q, 1)); }
dvec3 vector_of(const glm::dmat4& m, const dvec3& q) { return glm::dmat3(m) * q; }
dvec3 local_of(const glm::dmat4& m, const dvec3& x) { return dvec3(glm::inverse(m) * glm::dvec4(x, 1)); }

/// The half angle of the cylinder's visible part in its own frame, and the angle of p.
dvec2 visible_part(const glm::dmat4& m, const dvec3& p) {
  const dvec3 q = local_of(m, p);
  const double rho = std::hypot(q.x, q.y);
  return rho > 1 ? dvec2(std::acos(1 / rho), std::atan2(q.y, q.x)) : dvec2(kPi, 0);
}

std::vector<LightCase> light_cases() {
  std::vector<LightCase> cases;
  const auto rectangle_at = [](const glm::dmat4& m, const dvec3&, dvec2 st) {
    return std::pair(point_of(m, {2 * st.x - 1, 2 * st.y - 1, 0}),
                     glm::cross(vector_of(m, {2, 0, 0}), vector_of(m, {0, 2, 0})));
  };
  const auto rectangle_inverse = [](const glm::dmat4& m, const dvec3&, const dvec3& x) {
    return 0.5 * (dvec2(local_of(m, x)) + 1.0);
  };
  const glm::dmat4 turned = placed({3, -2, 5}, {1.2, 0.7, 1}, glm::normalize(dvec3(1, 2, 3)), 40);
  cases.push_back({"rectangle", RectangleShape{}, turned, false,
                   {point_of(turned, {0, 0, 0.05}), point_of(turned, {0.9, -0.5, 0.7}), point_of(turned, {3, 1, 2}),
                    point_of(turned, {-8, 20, 6}), point_of(turned, {2.5, 0, 0.02})},
                   rectangle_at, rectangle_inverse});
  const glm::dmat4 tiny = placed({1e4, 0, 0}, dvec3(1e-3), {1, 0, 0}, 90);
  const auto flipped_at = [rectangle_at](const glm::dmat4& m, const dvec3& p, dvec2 st) {
    const auto [point, area] = rectangle_at(m, p, st);
    return std::pair(point, -area);
  };
  cases.push_back({"far small rectangle", RectangleShape{}, tiny, true, {{1e4, 0.5, 0.2}, {1e4 + 0.002, 1e-3, 0}},
                   flipped_at, rectangle_inverse});
  cases.push_back(
      {"triangle", MeshShape{triangle_mesh()}, turned, false,
       {point_of(turned, {0.4, 0.4, 0.1}), point_of(turned, {3, 1, 2}), point_of(turned, {-2, 9, 6})},
       [](const glm::dmat4& m, const dvec3&, dvec2 st) {
         const dvec3 e1 = vector_of(m, {1, float{0.2f}, 0}), e2 = vector_of(m, {float{0.3f}, float{1.4f}, 0});
         return std::pair(point_of(m, {0, 0, 0}) + st.x * (1 - st.y) * e1 + st.y * e2, (1 - st.y) * glm::cross(e1, e2));
       },
       [](const glm::dmat4& m, const dvec3&, const dvec3& x) {
         const dvec3 e1 = vector_of(m, {1, float{0.2f}, 0}), e2 = vector_of(m, {float{0.3f}, float{1.4f}, 0});
         const dvec3 q = x - point_of(m, {0, 0, 0}), n = glm::cross(e1, e2);
         const double b1 = glm::dot(glm::cross(q, e2), n) / glm::dot(n, n);
         const double b2 = glm::dot(glm::cross(e1, q), n) / glm::dot(n, n);
         return dvec2(b1 / (1 - b2), b2);
       }});
  const glm::dmat4 ellipse = placed({3, -2, 5}, {1.5, 0.5, 1}, glm::normalize(dvec3(1, 2, 3)), 140);
  cases.push_back({"disk", DiskShape{}, ellipse, true,
                   {point_of(ellipse, {0, 0.1, -0.2}), point_of(ellipse, {3, 1, -2})},
                   [](const glm::dmat4& m, const dvec3&, dvec2 st) {
                     const double r = std::sqrt(st.x), phi = 2 * kPi * st.y;
                     return std::pair(point_of(m, {r * std::cos(phi), r * std::sin(phi), 0}),
                                      -kPi * glm::cross(vector_of(m, {1, 0, 0}), vector_of(m, {0, 1, 0})));
                   },
                   [](const glm::dmat4& m, const dvec3&, const dvec3& x) {
                     const dvec3 q = local_of(m, x);
                     const double turns = std::atan2(q.y, q.x) / (2 * kPi);
                     return dvec2(q.x * q.x + q.y * q.y, turns - std::floor(turns));
                   }});
  for (const bool inward : {false, true}) {
    const glm::dmat4 tube = placed({3, -2, 5}, {0.3, 0.5, 2}, glm::normalize(dvec3(1, 2, 3)), 70);
    LightCase c{inward ? "cylinder from inside" : "cylinder", CylinderShape{}, tube, inward, {}, {}, {}};
    c.points = inward ? std::vector<dvec3>{point_of(tube, {0.2, -0.3, 0.4})}
                      : std::vector<dvec3>{point_of(tube, {1.5, 0.4, 0.3}), point_of(tube, {-9, 20, 3})};
    c.at = [inward](const glm::dmat4& m, const dvec3& p, dvec2 st) {
      const dvec2 part = visible_part(m, p);
      const double phi = part.y + (2 * st.x - 1) * part.x;
      const dvec3 along = vector_of(m, {-std::sin(phi), std::cos(phi), 0});
      return std::pair(point_of(m, {std::cos(phi), std::sin(phi), st.y}),
                       (inward ? -2.0 : 2.0) * part.x * glm::cross(along, vector_of(m, {0, 0, 1})));
    };
    c.inverse = [](const glm::dmat4& m, const dvec3& p, const dvec3& x) {
      const dvec2 part = visible_part(m, p);
      const dvec3 q = local_of(m, x);
      return dvec2(0.5 + 0.5 * std::remainder(std::atan2(q.y, q.x) - part.y, 2 * kPi) / part.x, q.z);
    };
    cases.push_back(c);
  }
  return cases;
}

Scene scene_of(const LightCase& c) {
  Scene scene;
  add_shape(scene, c.kind, c.to_world);
  scene.shapes[0].flip_normals = c.flip;
  add_area_light(scene, 0, dvec3(2, 3, 5));
  return scene;
}

std::vector<LightQuery> queries_at(const glm::vec3& p, size_t count, uint32_t seed) {
  Uniform uniform(seed);
  std::vector<LightQuery> queries(count);
  for (LightQuery& q : queries) q = {p, {0, 0, 0}, uniform.two(), uniform()};
  return queries;
}

class LightArea : public DeviceTest {};

TEST_F(LightArea, SamplesFollowTheirDensity) {
  uint32_t seed = 1;
  for (const LightCase& c : light_cases()) {
    LightHarness harness(scene_of(c));
    for (const dvec3& world : c.points) {
      SCOPED_TRACE(c.name + fmt::format(" from ({}, {}, {})", world.x, world.y, world.z));
      const glm::vec3 p(world - harness.centre());
      const dvec3 exact_p = dvec3(p) + harness.centre();
      std::vector<double> observed(kBins * kBins + 1);
      for (const LightAnswer& a : harness.sample(queries_at(p, kSamples, seed++))) {
        const dvec2 st = c.inverse(c.to_world, exact_p, exact_p + dvec3(a.to_light));
        const bool inside = a.pdf > 0 && st.x > -1e-3 && st.x < 1.001 && st.y > -1e-3 && st.y < 1.001;
        const auto bin = [](double x) { return static_cast<size_t>(std::clamp(x * kBins, 0.0, kBins - 1.0)); };
        ++observed[inside ? bin(st.y) * kBins + bin(st.x) : kBins * kBins];
      }
      // Midpoints suffice: the density is smooth within a bin.
      std::vector<LightHit> hits;
      std::vector<double> measures;
      constexpr int kSide = kBins * kOrder;
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
          const auto [point, area] = c.at(c.to_world, exact_p, {(x + 0.5) / kSide, (y + 0.5) / kSide});
          const dvec3 to = point - exact_p;
          const double t = glm::length(to);
          LightHit hit;
          hit.p = p;
          hit.d = glm::vec3(to / t);
          hit.t = static_cast<float>(t);
          hit.n_s = glm::vec3(glm::normalize(area));
          hit.shape = 0;
          hits.push_back(hit);
          measures.push_back(std::abs(glm::dot(to / t, area)) / (t * t) / (kSide * kSide));
        }
      const std::vector<LightValue> values = harness.evaluate(hits);
      std::vector<double> expected(kBins * kBins + 1);
      double total = 0;
      for (size_t i = 0; i < values.size(); ++i) {
        const size_t y = i / kSide / kOrder, x = i % kSide / kOrder;
        expected[y * kBins + x] += double(kSamples) * double{values[i].pdf} * measures[i];
        total += double{values[i].pdf} * measures[i];
      }
      EXPECT_NEAR(total, 1, 2e-3) << "integral of the density";
      for (double& e : expected) e /= total;
      const Chi2Result result = chi2_test(observed, expected, sidak(0.01, kChi2Tests));
      EXPECT_TRUE(result.accepted) << result.message;
    }
  }
}

TEST_F(LightArea, SpheresFillTheirConeUniformly) {
  struct Case {
    dvec3 p;
    bool flip;
  };
  uint32_t seed = 100;
  for (const Case& c : {Case{{4, 0, 0}, false}, Case{{1.3, 0.2, 0}, false}, Case{{0, 3000, 40}, false},
                        Case{{0.3, 0.9, 0}, true}, Case{{0, 0, 0}, true}}) {
    Scene scene;
    add_shape(scene, SphereShape{{0.5, 0.5, 0}, 0.7}, placed({1, 2, 3}, dvec3(1.5)));
    scene.shapes[0].flip_normals = c.flip;
    add_area_light(scene, 0, dvec3(1));
    LightHarness harness(scene);
    const dvec3 centre(1.75, 2.75, 3);
    const glm::vec3 p(centre + c.p - harness.centre());
    const dvec3 to = -c.p;
    const double d = glm::length(to), r = 1.05;
    const double omc = c.flip ? 2 : 1 - std::sqrt(1 - r * r / (d * d));
    const SphereBins bins(
        {.axis = d > 0 ? to / d : dvec3(0, 0, 1), .omc_max = omc * (c.flip ? 1 : 1.0001)});
    std::vector<glm::vec4> directions;
    for (const LightAnswer& a : harness.sample(queries_at(p, kSamples, seed++))) {
      directions.emplace_back(a.pdf > 0 ? a.wi : glm::vec3(0), 0);
      EXPECT_NEAR(glm::length(dvec3(a.to_light) - to), r, 2e-5 * std::max(1.0, d)) << "on the sphere";
      ASSERT_NEAR(double{a.pdf} * 2 * kPi * omc, 1, 2e-5 * std::max(1.0, 1e-2 / omc * 1e-2));
      ASSERT_EQ(a.radiance, glm::vec3(1));
    }
    const std::vector<float> pdf(bins.quadrature_points().size(), static_cast<float>(1 / (2 * kPi * omc)));
    std::vector<double> expected = bins.expected(pdf, double(kSamples));
    // The bins' rim is a hair wider than the cone.
    const double sum = bins.integral(pdf);
    for (double& e : expected) e /= sum;
    expected.back() = 0;
    const Chi2Result result = chi2_test(bins.count(directions), expected, sidak(0.01, kChi2Tests));
    EXPECT_TRUE(result.accepted) << result.message;
  }
}

TEST_F(LightArea, BothSidesOfMisAgree) {
  Uniform uniform(7);
  for (const LightCase& c : light_cases()) {
    SCOPED_TRACE(c.name);
    LightHarness harness(scene_of(c));
    std::vector<LightQuery> queries;
    for (int i = 0; i < 4000; ++i) {
      const dvec3 world = c.points[static_cast<size_t>(i) % c.points.size()];
      const double spread = i < 2000 ? 0 : 0.1 * glm::length(world - dvec3(c.to_world[3]));
      const dvec3 offset = spread * (dvec3(uniform(), uniform(), uniform()) - 0.5);
      queries.push_back({glm::vec3(world + offset - harness.centre()), {0, 0, 0}, uniform.two(), uniform()});
    }
    const std::vector<LightAnswer> answers = harness.sample(queries);
    std::vector<LightHit> hits;
    for (size_t i = 0; i < answers.size(); ++i) {
      const LightAnswer& a = answers[i];
      LightHit hit;
      hit.p = queries[i].p;
      hit.d = a.wi;
      hit.t = glm::length(a.to_light);
      hit.key = a.key;
      hit.shape = 0;
      if (a.pdf > 0) {
        hit.primitive = harness.primitive_of(a.target);
        EXPECT_EQ(harness.shape_of(hit.primitive), 0);
      }
      const dvec3 exact_p = dvec3(hit.p) + harness.centre();
      const dvec2 st = c.inverse(c.to_world, exact_p, exact_p + dvec3(a.to_light));
      hit.n_s = glm::vec3(glm::normalize(c.at(c.to_world, exact_p, st).second));
      hits.push_back(hit);
    }
    const std::vector<LightValue> values = harness.evaluate(hits);
    for (size_t i = 0; i < values.size(); ++i) {
      if (answers[i].pdf == 0) continue;
      // At grazing angles t d loses digits of the height over the light.
      const double cosine = std::abs(glm::dot(glm::dvec3(hits[i].n_s), dvec3(hits[i].d)));
      ASSERT_NEAR(double{values[i].pdf} / double{answers[i].pdf}, 1, 1e-5 + 2e-6 / cosine) << i;
      if (cosine > 1e-3) {
        ASSERT_EQ(values[i].radiance, answers[i].radiance) << i;
      }
    }
  }
}

/// Irradiance [W/m^2] on a surface at p with normal n, by 1e5 samples, with its standard error.
dvec2 irradiance(LightHarness& harness, const glm::vec3& p, const dvec3& n, uint32_t seed) {
  double sum = 0, squares = 0;
  for (const LightAnswer& a : harness.sample(queries_at(p, kSamples, seed))) {
    const double value =
        a.pdf > 0 ? double{a.radiance.x} * std::max(0.0, glm::dot(n, dvec3(a.wi))) / double{a.pdf} : 0;
    sum += value;
    squares += value * value;
  }
  const double mean = sum / kSamples;
  return {mean, std::sqrt((squares / kSamples - mean * mean) / kSamples)};
}

/// Lambert's formula: E = L / 2 sum of the edges' angles times their normals' cosines. All corners above the horizon.
double polygon_irradiance(const std::vector<dvec3>& corners, const dvec3& p, const dvec3& n) {
  double sum = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const dvec3 a = corners[i] - p, b = corners[(i + 1) % corners.size()] - p, c = glm::cross(a, b);
    sum += std::atan2(glm::length(c), glm::dot(a, b)) * glm::dot(glm::normalize(c), n);
  }
  return 0.5 * std::abs(sum);
}

TEST_F(LightArea, IrradianceAgreesWithClosedForms) {
  // A rectangle [-1, 1]^2 at height h over points of a floor, also so close that it fills the sky.
  uint32_t seed = 500;
  for (const double h : {1e-3, 0.1, 1.0, 30.0}) {
    Scene scene;
    add_shape(scene, RectangleShape{}, placed({0, 0, h}, dvec3(1), {1, 0, 0}, 180));
    add_area_light(scene, 0, dvec3(2));
    LightHarness harness(scene);
    for (const dvec3& p : {dvec3(0), dvec3(0.7, 0.95, 0), dvec3(2.5, -0.3, 0)}) {
      if (h == 1e-3 && p.x > 1) continue;  // nearly nothing arrives, and with a huge variance
      const double exact =
          2 * polygon_irradiance({{-1, -1, h}, {1, -1, h}, {1, 1, h}, {-1, 1, h}}, p, {0, 0, 1});
      const dvec2 e = irradiance(harness, glm::vec3(p - harness.centre()), {0, 0, 1}, seed++);
      EXPECT_LT(e.y, 5e-3 * exact) << h;
      EXPECT_NEAR(e.x, exact, 4.42 * e.y + 2e-6 * exact) << "h = " << h << ", p.x = " << p.x;
    }
  }
  // A sphere: E = pi L (r / d)^2 on a surface that faces it.
  for (const double d : {1.02, 2.0, 100.0}) {
    Scene scene;
    add_shape(scene, SphereShape{}, placed({5, 6, 7}, dvec3(2)));
    add_area_light(scene, 0, dvec3(3));
    LightHarness harness(scene);
    const dvec3 w = glm::normalize(dvec3(1, -2, 0.5));
    const dvec2 e = irradiance(harness, glm::vec3(dvec3(5, 6, 7) - 2 * d * w - harness.centre()), w, seed++);
    EXPECT_NEAR(e.x, 3 * kPi / (d * d), 4.42 * e.y + 1e-5 * 3 * kPi / (d * d)) << d;
    EXPECT_LT(e.y, 5e-3 * e.x);
  }
  // A disk on its axis: E = pi L r^2 / (r^2 + d^2).
  Scene scene;
  add_shape(scene, DiskShape{}, placed({0, 0, 0}, dvec3(0.5)));
  add_area_light(scene, 0, dvec3(3));
  LightHarness harness(scene);
  const dvec2 e = irradiance(harness, glm::vec3(dvec3(0, 0, 1) - harness.centre()), {0, 0, -1}, seed++);
  EXPECT_NEAR(e.x, 3 * kPi * 0.25 / 1.25, 4.42 * e.y);
  EXPECT_LT(e.y, 5e-3 * e.x);
}

TEST_F(LightArea, CubesShineAsTheirVisibleFaces) {
  // Inside a cube with flipped normals every direction sees it: E = pi L, and each face is a rectangle.
  Scene scene;
  add_shape(scene, CubeShape{}, placed({1, 2, 3}, {1, 2, 0.5}, glm::normalize(dvec3(1, 1, 0)), 30));
  scene.shapes[0].flip_normals = true;
  add_area_light(scene, 0, dvec3(1));
  LightHarness harness(scene);
  EXPECT_EQ(harness.lights().count, 6u);
  EXPECT_EQ(harness.lights().kinds & (1u << gpu::kLightTriangles), 0u);
  const dvec2 e = irradiance(harness, glm::vec3(dvec3(1.2, 2.3, 3.1) - harness.centre()),
                             glm::normalize(dvec3(3, 1, 2)), 900);
  EXPECT_NEAR(e.x, kPi, 4.42 * e.y);
  EXPECT_LT(e.y, 5e-3 * kPi);
}

}  // namespace
}  // namespace tachylite::test
