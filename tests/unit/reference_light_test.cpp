// Lights of the reference against closed forms. Monte Carlo means are held to 5 standard errors (level 6e-7
// each, two-sided); the resolution given to EXPECT_MEAN bounds the standard error, 7.3 of which are seen with
// power 0.99.

#include <gtest/gtest.h>

#include "reference/light/light.h"
#include "support/chi2.h"
#include "unit/reference_support.h"

namespace tachylite {
namespace {

using namespace reference;
using namespace test;

/// Irradiance at p on a surface of normal n, by light sampling.
Mean irradiance(const Lights& lights, const dvec3& p, const dvec3& n, int samples, int channel = 1) {
  Random random(9, 0, 0);
  Mean mean;
  for (int i = 0; i < samples; ++i) {
    const auto light = lights.sample_light(p, random);
    mean.add(light ? light->weight[channel] * std::max(0.0, glm::dot(light->wi, n)) : 0);
  }
  return mean;
}

/// Lambert 1760: E = L/2 sum over the edges of angle * cos(normal of the edge's plane, n), for a polygon
/// above the horizon.
double lambert(const std::vector<dvec3>& polygon, const dvec3& p, const dvec3& n) {
  double sum = 0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const dvec3 a = glm::normalize(polygon[i] - p), b = glm::normalize(polygon[(i + 1) % polygon.size()] - p);
    sum += std::acos(glm::dot(a, b)) * glm::dot(glm::normalize(glm::cross(a, b)), n);
  }
  return 0.5 * sum;
}

TEST(ReferenceLight, RectangleMatchesLambertsFormula) {
  SceneBuilder b;
  const dmat4 place =
      moved({0.4, 0.2, 1.5}) * turned(160, glm::normalize(dvec3(1, 0.2, 0))) * scaled({0.8, 0.5, 1});
  b.add_area_light(b.add_shape(RectangleShape{}, place), dvec3(3));
  const Geometry geometry(b.scene);
  const Lights lights(geometry);
  std::vector<dvec3> corners;
  for (const dvec3& c : {dvec3(-1, -1, 0), dvec3(-1, 1, 0), dvec3(1, 1, 0), dvec3(1, -1, 0)}) {
    corners.push_back(transform_point(place, c));
  }
  const dvec3 n = glm::normalize(dvec3(0.2, -0.1, 1));
  EXPECT_MEAN(irradiance(lights, {0, 0, 0}, n, 40000), 3 * std::abs(lambert(corners, {0, 0, 0}, n)), 5e-3);
  // Behind it there is nothing.
  EXPECT_EQ(irradiance(lights, {0, 0, 4}, {0, 0, -1}, 100).mean(), 0);
}

/// A sphere of angular radius a whose centre is at theta < 90 degrees - a gives E = pi L sin^2 a cos theta.
TEST(ReferenceLight, SphereMatchesItsFormFactor) {
  SceneBuilder b;
  b.add_area_light(b.add_shape(SphereShape{{0, 1, 2}, 0.7}), dvec3(2));
  const Geometry geometry(b.scene);
  const Lights lights(geometry);
  const double d2 = 5, cos_theta = 2 / std::sqrt(5.0);
  EXPECT_MEAN(irradiance(lights, {0, 0, 0}, {0, 0, 1}, 200000), 2 * kPi * 0.49 / d2 * cos_theta, 3e-3);
}

/// A disk of radius R seen from its axis at height h: E = pi L R^2 / (R^2 + h^2). Cylinder: against
/// quadrature.
TEST(ReferenceLight, DiskAndCylinder) {
  SceneBuilder b;
  b.add_area_light(b.add_shape(DiskShape{}, moved({0, 0, 2}) * turned(180, {1, 0, 0}) * scaled(dvec3(1.5))),
                   dvec3(1));
  const Geometry disk_geometry(b.scene);
  const Lights disk(disk_geometry);
  EXPECT_MEAN(irradiance(disk, {0, 0, 0}, {0, 0, 1}, 40000), kPi * 2.25 / (2.25 + 4), 5e-3);

  SceneBuilder c;
  c.add_area_light(c.add_shape(CylinderShape{{0, 0, 1}, {0, 0, 2}, 0.3}), dvec3(1));
  const Geometry cylinder_geometry(c.scene);
  const Lights cylinder(cylinder_geometry);
  const dvec3 p(2, 0, 0), n = glm::normalize(dvec3(-1, 0, 1));
  double expected = 0;  // integral of cos cos / r^2 over the area
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double phi = 2 * kPi * (i + 0.5) / kSteps, z = 1 + (j + 0.5) / kSteps;
      const dvec3 nl(std::cos(phi), std::sin(phi), 0), q(0.3 * nl.x, 0.3 * nl.y, z), d = q - p;
      const double r2 = glm::dot(d, d);
      expected += std::max(0.0, -glm::dot(d, nl)) * std::max(0.0, glm::dot(d, n)) / sqr(r2);
    }
  }
  expected *= 2 * kPi * 0.3 / sqr(kSteps);
  EXPECT_MEAN(irradiance(cylinder, p, n, 40000), expected, 2e-3);
}

TEST(ReferenceLight, PointSpotDirectionalProjector) {
  const dvec3 up(0, 0, 1);
  const auto one = [&](const auto& emitter, const dvec3& p, const dvec3& n) {
    SceneBuilder b;
    b.add_light(emitter);
    const Geometry geometry(b.scene);
    return irradiance(Lights(geometry), p, n, 1).mean();
  };
  EXPECT_NEAR(one(PointEmitter{{0, 0, 3}, dvec3(6)}, {0, 0, 0}, up), 6.0 / 9, 1e-12);
  EXPECT_NEAR(one(PointEmitter{{4, 0, 3}, dvec3(6)}, {0, 0, 0}, up), 6.0 / 25 * 0.6, 1e-12);
  EXPECT_NEAR(one(DirectionalEmitter{{0, 3, -4}, dvec3(2)}, {7, 7, 7}, up), 2 * 0.8, 1e-12);

  // A spot at z = 2 that looks down; angles 30 (full) and 50 degrees.
  SpotEmitter spot{moved({0, 0, 2}) * turned(180, {1, 0, 0}), dvec3(4), glm::radians(50.0),
                   glm::radians(30.0), kNone};
  for (const double degrees : {0.0, 29.0, 40.0, 49.0, 51.0}) {
    const double theta = glm::radians(degrees), falloff = std::clamp((50 - degrees) / 20, 0.0, 1.0);
    const double expected = 4 * falloff * std::pow(std::cos(theta), 3) / 4;
    EXPECT_NEAR(one(spot, {2 * std::tan(theta), 0, 0}, up), expected, 1e-12) << degrees;
  }

  // A projector lights a plane that faces it evenly: pi scale E / z^2 at any point of its image.
  ProjectorEmitter projector{moved({0, 0, 2}) * turned(180, {1, 0, 0}), kNone, dvec3(0.5), 3,
                             glm::radians(90.0)};
  for (const dvec2& p : {dvec2(0, 0), dvec2(1.9, 0), dvec2(-1.5, 1.9)}) {
    EXPECT_NEAR(one(projector, dvec3(p, 0), up), kPi * 3 * 0.5 / 4, 1e-12);
  }
  EXPECT_EQ(one(projector, {2.1, 0, 0}, up), 0);
  EXPECT_EQ(one(projector, {0, 0, 3}, up), 0);
}

std::shared_ptr<Bitmap> sky(int width, int height) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = width;
  bitmap->height = height;
  bitmap->channels = 3;
  Random random(2, 0, 0);
  for (int i = 0; i < width * height; ++i) {
    const bool sun = i == width + 3;
    for (int c = 0; c < 3; ++c) bitmap->floats.push_back(static_cast<float>(sun ? 500 : random.uniform()));
  }
  return bitmap;
}

TEST(ReferenceLight, EnvmapLookup) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = 4;
  bitmap->height = 3;
  bitmap->channels = 1;
  bitmap->floats = {9, 9, 9, 9, 1, 2, 3, 4, 5, 5, 5, 5};
  const EnvironmentEmitter emitter{bitmap, false, 2, dmat4(1)};
  const Envmap envmap(emitter);
  EXPECT_NEAR(envmap.radiance({0, 1, 0}).x, 18, 1e-9);   // row 0 is the zenith
  EXPECT_NEAR(envmap.radiance({0, -1, 0}).x, 10, 1e-9);  // the last row the nadir
  // The middle row is the horizon. -z is u = 0, halfway between columns 3 and 0; +x is u = 1/4, between 0
  // and 1.
  EXPECT_NEAR(envmap.radiance({0, 0, -1}).x, 2 * 2.5, 1e-9);
  EXPECT_NEAR(envmap.radiance({1, 0, 0}).x, 2 * 1.5, 1e-9);
  EXPECT_NEAR(envmap.radiance({0, 0, 1}).x, 2 * 2.5, 1e-9);
  EXPECT_NEAR(envmap.radiance(glm::normalize(dvec3(1, 0, -1))).x, 2 * 1.0, 1e-9);  // the centre of column 0
  EXPECT_NEAR(envmap.radiance(glm::normalize(dvec3(1, 0, 1))).x, 2 * 2.0, 1e-9);   // of column 1
}

/// With a sun and turned: samples in the cells between texels against their density (chi2, level 0.01), its
/// integral, and the irradiance that samples give against quadrature of the lookup.
TEST(ReferenceLight, EnvmapSampling) {
  constexpr int kWidth = 12, kRows = 8;
  const dmat4 turn = turned(40, glm::normalize(dvec3(1, 1, 0.3)));
  SceneBuilder b;
  b.add_light(EnvironmentEmitter{sky(kWidth, kRows + 1), false, 1, turn});
  const Geometry geometry(b.scene);
  const Lights lights(geometry);
  const Envmap envmap(std::get<EnvironmentEmitter>(b.scene.emitters[0].kind));
  const auto direction = [&](double u, double v) {
    const double phi = 2 * kPi * u, theta = kPi * v;
    return dmat3(turn) *
           dvec3(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
  };

  constexpr int kSamples = 20000;
  std::vector<double> expected(kWidth * kRows), observed(kWidth * kRows);
  for (int y = 0; y < kRows; ++y) {
    const double solid_angle =
        2 * kPi / kWidth * (std::cos(kPi * y / kRows) - std::cos(kPi * (y + 1) / kRows));
    for (int x = 0; x < kWidth; ++x) {
      const double pdf = envmap.pdf_direction(direction((x + 1.0) / kWidth, (y + 0.5) / kRows));
      expected[static_cast<size_t>(y * kWidth + x)] = kSamples * pdf * solid_angle;
      EXPECT_NEAR(envmap.pdf_direction(direction((x + 0.6) / kWidth, (y + 0.9) / kRows)), pdf,
                  1e-9);  // constant
    }
  }
  Random random(8, 0, 0);
  for (int i = 0; i < kSamples; ++i) {
    const dvec3 d = glm::transpose(dmat3(turn)) * envmap.sample_direction(random);
    const double u = std::atan2(d.x, -d.z) / (2 * kPi) - 0.5 / kWidth, v = std::acos(d.y) / kPi;
    const int x = static_cast<int>((u - std::floor(u)) * kWidth), y = static_cast<int>(v * kRows);
    observed[static_cast<size_t>(y * kWidth + x)] += 1;
  }
  const auto result = chi2_test(observed, expected, 0.01);  // also that the density integrates to 1
  EXPECT_TRUE(result.accepted) << result.message;

  const dvec3 n = glm::normalize(dvec3(0.3, 1, 0.2));
  double irradiance_y = 0;
  constexpr int kSteps = 800;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const dvec3 d = direction((i + 0.5) / kSteps, (j + 0.5) / kSteps);
      irradiance_y += luminance(lights.environment(d)) * std::max(0.0, glm::dot(d, n)) *
                      std::sin(kPi * (j + 0.5) / kSteps) * 2 * kPi * kPi / sqr(kSteps);
    }
  }
  Mean mean;
  for (int i = 0; i < 100000; ++i) {
    const auto light = lights.sample_light({0, 0, 0}, random);
    mean.add(luminance(light->weight) * std::max(0.0, glm::dot(light->wi, n)));
  }
  EXPECT_LT(mean.standard_error(), 0.005 * mean.mean());
  EXPECT_NEAR(mean.mean(), irradiance_y, 5 * mean.standard_error() + 1e-3 * irradiance_y);
}

/// The densities that hits are weighted with are those of the samples.
TEST(ReferenceLight, DensitiesOfHitsAndSamplesAgree) {
  SceneBuilder b;
  b.add_area_light(b.add_shape(SphereShape{{3, 0, 0}, 1}), dvec3(1));
  b.add_area_light(b.add_shape(CubeShape{}, moved({0, 4, 0}) * turned(20, {0, 0, 1})), dvec3(1));
  b.add_light(PointEmitter{{0, 0, 5}, dvec3(1)});
  b.add_light(EnvironmentEmitter{sky(12, 9), false, 1, dmat4(1)});
  const Geometry geometry(b.scene);
  const Lights lights(geometry);
  Random random(4, 0, 0);
  const dvec3 p(0, 0, 0);
  int surfaces = 0, sky_samples = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto light = lights.sample_light(p, random);
    if (!light || light->delta) continue;
    const auto hit = geometry.intersect({p, light->wi});
    const Ray shadow = Lights::shadow_ray(p, *light);
    EXPECT_FALSE(light->target && geometry.occluded(shadow));
    if (light->target && hit) {
      EXPECT_NEAR(lights.pdf_surface(p, *hit) / light->pdf, 1, 1e-6);
      ++surfaces;
    } else if (!light->target) {
      EXPECT_NEAR(lights.pdf_environment(light->wi) / light->pdf, 1, 1e-9);
      ++sky_samples;
    }
  }
  EXPECT_GT(surfaces, 100);
  EXPECT_GT(sky_samples, 100);
}

}  // namespace
}  // namespace tachylite
