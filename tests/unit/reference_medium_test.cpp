// Media of the reference: phase functions, free flights and transmittance against closed forms and
// quadrature. Means are tested as in reference_light_test.cpp.

#include <gtest/gtest.h>

#include "reference/medium/henyey_greenstein.h"
#include "reference/medium/phase_function.h"
#include "unit/reference_support.h"

namespace tachylite {
namespace {

using namespace reference;
using namespace test;

TEST(ReferencePhase, HenyeyGreensteinIsNormalisedWithMeanCosineG) {
  for (const double g : {-0.9, -0.3, 0.0, 1e-6, 0.5, 0.95}) {
    double integral = 0, mean = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double c = -1 + 2 * (i + 0.5) / kSteps, p = 2 * kPi * eval_henyey_greenstein(g, c) * 2 / kSteps;
      integral += p;
      mean += p * c;
    }
    EXPECT_NEAR(integral, 1, 1e-5) << g;
    EXPECT_NEAR(mean, g, 1e-5) << g;

    // Samples: first and second moments; E[c^2] = (1 + 2 g^2) / 3.
    Random random(1, 0, 0);
    Mean c1, c2;
    for (int i = 0; i < 40000; ++i) {
      const double c = sample_henyey_greenstein(g, random.uniform());
      c1.add(c);
      c2.add(c * c);
    }
    EXPECT_MEAN(c1, g, 4e-3);
    EXPECT_MEAN(c2, (1 + 2 * g * g) / 3, 4e-3);
  }
}

TEST(ReferencePhase, DirectionsAndBlends) {
  PhaseFunction forward{{}, HenyeyGreensteinPhase{0.7}}, backward{{}, HenyeyGreensteinPhase{-0.4}};
  const PhaseFunction blend{
      {},
      BlendPhase{std::make_shared<PhaseFunction>(forward), std::make_shared<PhaseFunction>(backward), 0.25}};
  const dvec3 wo = glm::normalize(dvec3(1, 2, -1));
  EXPECT_GT(eval_phase(forward, wo, -wo), eval_phase(forward, wo, wo));  // forward is on along -wo
  EXPECT_NEAR(eval_phase(blend, wo, -wo),
              0.75 * eval_phase(forward, wo, -wo) + 0.25 * eval_phase(backward, wo, -wo), 1e-15);
  Random random(2, 0, 0);
  Mean cosine;
  for (int i = 0; i < 40000; ++i) cosine.add(-glm::dot(wo, sample_phase(blend, wo, random)));
  EXPECT_MEAN(cosine, 0.75 * 0.7 - 0.25 * 0.4, 5e-3);
}

/// A grid of 3 x 2 x 2 voxels over [-1, 2]^3 of the world.
Medium grid_medium(int channels) {
  auto grid = std::make_shared<Grid>();
  grid->nx = 3;
  grid->ny = grid->nz = 2;
  grid->channels = channels;
  Random random(5, 0, 0);
  for (int i = 0; i < 12 * channels; ++i) grid->values.push_back(static_cast<float>(random.uniform()));
  HeterogeneousMedium medium;
  medium.sigma_t.grid = grid;
  medium.sigma_t.to_world = moved(dvec3(-1)) * scaled(dvec3(3));
  medium.albedo.constant = dvec3(0.9, 0.5, 0.2);
  medium.scale = 1.5;
  return {{}, "", medium, {}};
}

Medium homogeneous_medium(const dvec3& sigma_t) {
  return {{}, "", HomogeneousMedium{sigma_t, dvec3(0.9, 0.5, 0.2)}, {}};
}

/// Optical depth along o + t d up to t_end by the midpoint rule.
dvec3 optical_depth(const Medium& medium, const dvec3& o, const dvec3& d, double t_end) {
  if (const auto* homogeneous = std::get_if<HomogeneousMedium>(&medium.kind))
    return homogeneous->sigma_t * t_end;
  const auto& grid = std::get<HeterogeneousMedium>(medium.kind);
  const GridVolume volume(grid.sigma_t);
  dvec3 sum(0);
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const dvec3 p = o + t_end * (i + 0.5) / double{kSteps} * d;
    if (glm::all(glm::greaterThan(p, volume.box_low())) && glm::all(glm::lessThan(p, volume.box_high()))) {
      sum += grid.scale * volume.value(p) * (t_end / kSteps);
    }
  }
  return sum;
}

TEST(ReferenceMedium, GridLookup) {
  auto grid = std::make_shared<Grid>();
  grid->nx = 2;
  grid->ny = 1;
  grid->nz = 2;
  grid->channels = 1;
  grid->values = {1, 2, 3, 5};  // x fastest
  Volume volume;
  volume.grid = grid;
  volume.to_world = scaled({2, 2, 2});
  EXPECT_NEAR(GridVolume(volume).value({0.5, 1, 0.5}).x, 1, 1e-12);
  EXPECT_NEAR(GridVolume(volume).value({1.5, 1, 0.5}).x, 2, 1e-12);
  EXPECT_NEAR(GridVolume(volume).value({1, 0, 1}).x, 2.75, 1e-12);
  EXPECT_NEAR(GridVolume(volume).value({-5, 0, 9}).x, 3, 1e-12);  // clamped
  EXPECT_EQ(GridVolume(volume).box_high(), dvec3(2));
  volume.filter = FilterType::kNearest;
  EXPECT_EQ(GridVolume(volume).value({0.99, 0, 1.01}).x, 3);
  volume.use_grid_bbox = true;
  grid->bbox_min = dvec3(1);
  grid->bbox_max = dvec3(3);
  EXPECT_EQ(GridVolume(volume).box_low(), dvec3(2));
  EXPECT_EQ(GridVolume(volume).box_high(), dvec3(6));
}

/// Free flights: throughput that reaches the end has the mean T; that of collisions, the mean albedo (1 - T);
/// and the mean of an exponential moment of the distance matches quadrature. Coloured and grey, homogeneous
/// and not.
TEST(ReferenceMedium, FreeFlightsAndTransmittance) {
  Scene scene;
  scene.media = {homogeneous_medium(dvec3(0.7)), homogeneous_medium({0.1, 0.9, 3}),
                 homogeneous_medium({0, 1, 0.5}), grid_medium(1), grid_medium(3)};
  const Media media(scene);
  for (MediumIndex m = 0; m < 5; ++m) {
    SCOPED_TRACE(m);
    const Medium& medium = scene.media[static_cast<size_t>(m)];
    const Ray ray{{-2, 0.1, -0.3}, glm::normalize(dvec3(1, 0.3, 0.4)), 3.5};
    const dvec3 t = glm::exp(-optical_depth(medium, ray.origin, ray.direction, ray.t_max));
    const dvec3 albedo(0.9, 0.5, 0.2);
    for (int c = 0; c < 3; ++c) {
      Random random(3, 0, 0);
      Mean end, collided, transmittance;
      for (int i = 0; i < 40000; ++i) {
        dvec3 throughput(1, 1, 1);
        const auto collision = media.sample_free_flight(m, ray, throughput, random);
        end.add(collision ? 0 : throughput[c]);
        collided.add(collision ? throughput[c] : 0);
        // The same segment with a direction of another length.
        const Ray stretched{ray.origin, 2.0 * ray.direction, 0.5 * ray.t_max};
        transmittance.add(media.transmittance(m, stretched, random)[c]);
        if (collision) {
          EXPECT_LT(*collision, ray.t_max);
        }
      }
      EXPECT_MEAN(end, t[c], 8e-3);
      EXPECT_MEAN(collided, albedo[c] * (1 - t[c]), 8e-3);
      EXPECT_MEAN(transmittance, t[c], 4e-3);
    }
  }
}

TEST(ReferenceMedium, CollisionsAreDistributedAsTheyShould) {
  Scene scene;
  scene.media = {homogeneous_medium({0.5, 2, 1}), grid_medium(3)};
  const Media media(scene);
  const Ray ray{{-2, 0.1, -0.3}, glm::normalize(dvec3(1, 0.3, 0.4)), 5};
  for (MediumIndex m = 0; m < 2; ++m) {
    // E[t; collision] = albedo (integral of T(t) dt - t_end T(t_end)) by parts.
    const Medium& medium = scene.media[static_cast<size_t>(m)];
    dvec3 expected = -ray.t_max * glm::exp(-optical_depth(medium, ray.origin, ray.direction, ray.t_max));
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i) {
      const double t = ray.t_max * (i + 0.5) / kSteps;
      expected += glm::exp(-optical_depth(medium, ray.origin, ray.direction, t)) * (ray.t_max / kSteps);
    }
    expected *= dvec3(0.9, 0.5, 0.2);
    for (int c = 0; c < 3; ++c) {
      Random random(6, 0, 0);
      Mean mean;
      for (int i = 0; i < 60000; ++i) {
        dvec3 throughput(1, 0.5, 2);  // the channel is chosen by throughput
        const double start = throughput[c];
        const auto collision = media.sample_free_flight(m, ray, throughput, random);
        mean.add(collision ? *collision * throughput[c] / start : 0);
      }
      EXPECT_MEAN(mean, expected[c], 0.02);
    }
  }
}

/// Nothing breaks in empty, opaque and endless media.
TEST(ReferenceMedium, Extremes) {
  Scene scene;
  scene.media = {homogeneous_medium(dvec3(0)), homogeneous_medium(dvec3(1e12)),
                 homogeneous_medium({1e-9, 1, 1e9})};
  const Media media(scene);
  Random random(1, 0, 0);
  for (const double end : {1e-3, 1.0, 1e6, kInfinity}) {
    const Ray ray{{0, 0, 0}, {0, 0, 1}, end};
    for (int i = 0; i < 100; ++i) {
      dvec3 throughput(1);
      EXPECT_FALSE(media.sample_free_flight(0, ray, throughput, random));
      EXPECT_EQ(throughput, dvec3(1));
      EXPECT_TRUE(media.sample_free_flight(1, ray, throughput, random));
      EXPECT_TRUE(is_finite(throughput));
      throughput = dvec3(1);
      media.sample_free_flight(2, ray, throughput, random);
      EXPECT_TRUE(is_finite(throughput));
      EXPECT_LE(throughput.x + throughput.y + throughput.z, 3 * (1 + 1e-12));  // albedo < 1: never grows
    }
    EXPECT_EQ(media.transmittance(0, ray, random), dvec3(1));
    EXPECT_EQ(media.transmittance(1, ray, random), dvec3(0));
  }
}

}  // namespace
}  // namespace tachylite
