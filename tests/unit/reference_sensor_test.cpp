// Cameras and reconstruction filters of the reference. Means are tested as in reference_light_test.cpp.

#include <gtest/gtest.h>

#include "reference/sensor.h"
#include "unit/reference_support.h"

namespace tachylite {
namespace {

using namespace reference;
using namespace test;

Film film_of(ReconstructionFilter filter, double radius, double stddev) {
  Film film;
  film.width = film.crop_width = 64;
  film.height = film.crop_height = 48;
  film.filter = filter;
  film.filter_radius = radius;
  film.gaussian_stddev = stddev;
  return film;
}

/// The second moment of the offset from the pixel's centre: r^2/3 for the box, r^2/6 for the tent, quadrature
/// of the lowered gaussian; and at the film's edge nothing beyond it.
TEST(ReferenceSensor, FiltersAreSampledByTheirShape) {
  const auto gaussian = [](double x) {
    return std::exp(-2 * x * x) - std::exp(-8.0);
  };  // stddev 0.5, radius 2
  double weight = 0, moment = 0;
  for (int i = 0; i < 4000; ++i) {
    const double x = 2 * (i + 0.5) / 4000;
    weight += gaussian(x);
    moment += gaussian(x) * x * x;
  }
  const std::pair<Film, double> cases[] = {
      {film_of(ReconstructionFilter::kBox, 0.5, 0), 0.25 / 3},
      {film_of(ReconstructionFilter::kTent, 1, 0), 1.0 / 6},
      {film_of(ReconstructionFilter::kGaussian, 2, 0.5), moment / weight}};
  for (const auto& [film, expected] : cases) {
    Random random(1, 0, 0);
    Mean first, second;
    for (int i = 0; i < 40000; ++i) {
      const dvec2 offset = sample_film_position(film, 10, 20, random) - dvec2(10.5, 20.5);
      first.add(offset.x);
      second.add(offset.y * offset.y);
      EXPECT_LE(max_abs(dvec3(offset, 0)), film.filter_radius);
      const dvec2 corner = sample_film_position(film, 0, 47, random);
      EXPECT_TRUE(corner.x >= 0 && corner.y < 48);
    }
    EXPECT_MEAN(first, 0, 5e-3);
    EXPECT_MEAN(second, expected, 4e-3);
  }
}

TEST(ReferenceSensor, PerspectiveRays) {
  SceneBuilder b;
  Sensor& sensor = b.scene.sensors[0];
  sensor.film = film_of(ReconstructionFilter::kBox, 0.5, 0);
  sensor.x_fov = 2 * std::atan(0.5);
  sensor.near_clip = 1;
  sensor.far_clip = 11;
  Random random(1, 0, 0);
  const auto direction = [&](double x, double y) {
    const dvec3 d = sample_camera_ray(sensor, {x, y}, random).direction;
    return d / d.z;
  };
  EXPECT_LT(glm::distance(direction(32, 24), dvec3(0, 0, 1)), 1e-12);
  EXPECT_LT(glm::distance(direction(0, 24), dvec3(0.5, 0, 1)), 1e-12);    // the left edge is +x
  EXPECT_LT(glm::distance(direction(32, 0), dvec3(0, 0.375, 1)), 1e-12);  // the top edge is +y
  const Ray corner = sample_camera_ray(sensor, {0, 0}, random);
  EXPECT_NEAR(corner.origin.z, 1, 1e-12);
  EXPECT_NEAR((corner.origin + corner.t_max * corner.direction).z, 11, 1e-9);
  // The principal point offset is added to the position: a quarter of the width to the right.
  sensor.principal_point_offset = {0.25, 0};
  EXPECT_LT(glm::distance(direction(0, 24), dvec3(0.25, 0, 1)), 1e-12);
}

TEST(ReferenceSensor, ThinLensFocusesItsPlane) {
  SceneBuilder b;
  Sensor& sensor = b.scene.sensors[0];
  sensor.kind = Sensor::Kind::kThinLens;
  sensor.film = film_of(ReconstructionFilter::kBox, 0.5, 0);
  sensor.x_fov = 1;
  sensor.aperture_radius = 0.3;
  sensor.focus_distance = 5;
  Random random(2, 0, 0);
  Mean radius2;  // of the lens points: uniform on a disk, r^2 / 2
  const dvec3 focus = 5.0 * dvec3(0.5 * std::tan(0.5), -0.375 * std::tan(0.5), 1);
  for (int i = 0; i < 20000; ++i) {
    const Ray ray = sample_camera_ray(sensor, {16, 36}, random);
    const dvec3 at_lens = ray.origin - ray.direction * (ray.origin.z / ray.direction.z);
    const dvec3 at_focus = ray.origin + ray.direction * ((5 - ray.origin.z) / ray.direction.z);
    EXPECT_LT(glm::distance(at_focus, focus), 1e-9);
    radius2.add(glm::dot(at_lens, at_lens));
  }
  EXPECT_MEAN(radius2, 0.045, 1e-3);
}

TEST(ReferenceSensor, OrthographicRaysAreParallel) {
  SceneBuilder b;
  Sensor& sensor = b.scene.sensors[0];
  sensor.kind = Sensor::Kind::kOrthographic;
  sensor.film = film_of(ReconstructionFilter::kBox, 0.5, 0);
  sensor.to_world = scaled({3, 3, 1});
  Random random(3, 0, 0);
  const Ray ray = sample_camera_ray(sensor, {0, 48}, random);
  EXPECT_LT(glm::distance(ray.direction, dvec3(0, 0, 1)), 1e-12);
  EXPECT_NEAR(ray.origin.x, 3, 1e-12);
  EXPECT_NEAR(ray.origin.y, -3 * 0.75, 1e-12);
}

}  // namespace
}  // namespace tachylite
