// Media on grids: optical depths in closed form, through spikes and empty voxels, by free flight and by shadow rays.

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pack/majorant_grid.h"
#include "reference/reference.h"
#include "shared/medium.h"
#include "support/render_test.h"

namespace tachylite::test {
namespace {

using MediumGrid = DeviceTest;
using glm::dvec3;

constexpr int kVoxels = 8, kSize = 32;
constexpr double kColumn[kVoxels] = {0, 0, 3, 0, 0.2, 0, 0, 1.5};  // sigma_t along z at the camera's voxel

/// 8^3 voxels of one or three channels over the cube [-1, 1]^3: empty but for a column and spikes beside it.
std::shared_ptr<Grid> column_grid(int channels) {
  auto grid = std::make_shared<Grid>();
  grid->nx = grid->ny = grid->nz = kVoxels;
  grid->channels = channels;
  grid->values.assign(static_cast<size_t>(kVoxels * kVoxels * kVoxels * channels), 0.0f);
  const auto set = [&](int x, int y, int z, double value) {
    for (int c = 0; c < channels; ++c)
      grid->values[static_cast<size_t>(channels * ((z * kVoxels + y) * kVoxels + x) + c)] =
          static_cast<float>(value / (1 << c));
  };
  for (int z = 0; z < kVoxels; ++z) {
    set(4, 4, z, kColumn[z]);
    set(5, 4, z, z == 5 ? 400 : 0);
    set(4, 6, z, 50);
  }
  return grid;
}

/// Seen along z through the centres of the column's voxels, where both filters have the same integral.
Scene column_scene(FilterType filter, double scale, const std::string& light, const std::string& camera_z,
                   int channels = 3) {
  Scene scene = scene_from_elements(
      R"(<integrator type="volpath"><integer name="max_depth" value="2"/></integrator>)" +
      sensor_element(kSize, kSize, "0.125, 0.125, " + camera_z, "0.125, 0.125, -9", 1e-3) + light +
      R"(<shape type="cube"><transform name="to_world"><scale value="1.5"/></transform><bsdf type="null"/>
<medium name="interior" type="homogeneous"/></shape>)");
  HeterogeneousMedium medium;
  medium.scale = scale;
  medium.albedo.constant = dvec3(0);
  medium.sigma_t.grid = column_grid(channels);
  medium.sigma_t.filter = filter;
  medium.sigma_t.to_world = dmat4(2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, -1, -1, -1, 1);
  scene.media[0].kind = medium;
  return scene;
}

/// Transmittance of the column of three channels; the first is that of one channel, too.
dvec3 column_transmittance(double scale) {
  double sum = 0;
  for (const double value : kColumn) sum += scale * value * 2 / kVoxels;
  return glm::exp(-sum * dvec3(1, 0.5, 0.25));
}

/// Every pixel has the expectation `expected`.
void expect_pixels(const Scene& scene, const dvec3& expected, const char* name, int samples = 64) {
  RenderOptions options;
  options.samples = samples;
  const DeviceRender result = render_on_device(scene, options);
  EXPECT_EQ(result.statistics.nonfinite + result.statistics.overflow, 0u);
  constexpr size_t kPixels = kSize * kSize;
  dvec3 mean(0), squares(0);
  for (size_t i = 0; i < kPixels; ++i) {
    mean += result.film.mean(i) / double{kPixels};
    squares += result.film.mean(i) * result.film.mean(i) / double{kPixels};
  }
  const dvec3 deviation = glm::sqrt(glm::max(squares - mean * mean, dvec3(0)) / double{kPixels});
  for (int c = 0; c < 3; ++c) {
    // 5 deviations: 6e-7; a bias of 8 % is beyond 10 of them.
    EXPECT_NEAR(mean[c], expected[c], 5 * deviation[c] + 1e-4 * expected[c]) << name << " " << c;
    EXPECT_LE(deviation[c], 0.008 * expected[c]) << name << " " << c;
  }
}

TEST_F(MediumGrid, OpticalDepthThroughSpikesAndEmptyVoxels) {
  const std::string sky = R"(<emitter type="constant"><rgb name="radiance" value="1, 1, 1"/></emitter>)";
  const std::string wall = R"(<shape type="rectangle"><transform name="to_world"><scale value="9"/>
<translate z="-1.6"/></transform><bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.5, 0.5"/></bsdf></shape>
<emitter type="directional"><vector name="direction" x="0" y="0" z="-1"/>
<rgb name="irradiance" value="1, 1, 1"/></emitter>)";
  for (const FilterType filter : {FilterType::kNearest, FilterType::kBilinear}) {
    expect_pixels(column_scene(filter, 1, sky, "4"), column_transmittance(1), "sky");
    // The camera behind the cube: only shadow rays pass it.
    expect_pixels(column_scene(filter, 1, wall, "-1.55"), 0.5 / std::numbers::pi * column_transmittance(1),
                  "wall");
  }
  // One channel, and so dense that Russian roulette ends most shadow rays.
  const dvec3 dense(column_transmittance(2.7).x);
  ASSERT_LT(dense.x, 0.5 * gpu::kLeastTransmittance);
  expect_pixels(column_scene(FilterType::kBilinear, 2.7, wall, "-1.55", 1), 0.5 / std::numbers::pi * dense, "dense",
                256);
}

TEST_F(MediumGrid, ConstantExtinctionFillsTheUnitCube) {
  // As Mitsuba's constvolume: a medium ends with the box of its sigma_t, here z = -0.3 to 0.5, whatever holds it.
  const std::string sky = R"(<emitter type="constant"><rgb name="radiance" value="1, 1, 1"/></emitter>)";
  Scene scene = column_scene(FilterType::kNearest, 1.5, sky, "4");
  auto& medium = std::get<HeterogeneousMedium>(scene.media[0].kind);
  medium.sigma_t = {};
  medium.sigma_t.constant = dvec3(1, 0.5, 0);
  medium.sigma_t.to_world = dmat4(0.4, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0.8, 0, -0.1, -1, -0.3, 1);
  expect_pixels(scene, glm::exp(-1.5 * 0.8 * dvec3(1, 0.5, 0)), "device");

  ReferenceOptions options;
  options.samples = 64;
  const ReferenceImage image = render_reference(scene, options);
  dvec3 mean(0);
  for (const dvec3& pixel : image.mean) mean += pixel / double{kSize * kSize};
  for (int c = 0; c < 3; ++c)  // 5 deviations of the mean of as many coins
    EXPECT_NEAR(mean[c], std::exp(-1.2 * medium.sigma_t.constant[c]), 5 * 0.5 / std::sqrt(64.0 * kSize * kSize)) << c;
}

TEST(MajorantGrid, BoundsEveryPointOfItsCells) {
  uint32_t seed = 7;
  const auto uniform = [&] {
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) / 16777216.0;
  };
  for (const WrapMode mode : {WrapMode::kClamp, WrapMode::kRepeat, WrapMode::kMirror})
    for (const FilterType filter : {FilterType::kNearest, FilterType::kBilinear}) {
      Volume volume;
      volume.filter = filter;
      volume.wrap = mode;
      auto grid = std::make_shared<Grid>();
      grid->nx = 5, grid->ny = 40, grid->nz = 3, grid->channels = 1;
      for (int i = 0; i < 5 * 40 * 3; ++i) grid->values.push_back(uniform() < 0.9 ? 0.0f : float(uniform()));
      volume.grid = grid;
      volume.to_world = dmat4(0.8, 0, -0.6, 0, 0, 3, 0, 0, 0.6, 0, 0.8, 0, 1, 2, 3, 1);
      const dvec3 low(0.5, 1.5, 2), high(3, 6, 4.5);
      const MajorantGrid bounds = bound_volume(volume, low, high);
      const dmat4 to_index = glm::inverse(volume.to_world);
      const dvec3 n(5, 40, 3);
      size_t tight = 0;
      for (int i = 0; i < 20000; ++i) {
        const dvec3 unit(uniform(), uniform(), uniform()), p = low + unit * (high - low);
        const dvec3 q = dvec3(to_index * glm::dvec4(p, 1)) * n;
        const auto voxel = [&](const dvec3& index) {
          size_t at[3];
          for (int k = 0; k < 3; ++k) {
            double j = index[k];
            if (mode == WrapMode::kClamp) j = std::clamp(j, 0.0, n[k] - 1);
            if (mode == WrapMode::kRepeat) j -= n[k] * std::floor(j / n[k]);
            if (mode == WrapMode::kMirror) {
              j -= 2 * n[k] * std::floor(j / (2 * n[k]));
              j = std::min(j, 2 * n[k] - 1 - j);
            }
            at[k] = static_cast<size_t>(j);
          }
          return double{grid->values[(at[2] * 40 + at[1]) * 5 + at[0]]};
        };
        double value = 0;
        if (filter == FilterType::kNearest) {
          value = voxel(glm::floor(q));
        } else {
          const dvec3 base = glm::floor(q - 0.5), f = q - 0.5 - base;
          for (int corner = 0; corner < 8; ++corner) {
            const dvec3 step(corner & 1, (corner >> 1) & 1, corner >> 2), w = glm::mix(1.0 - f, f, step);
            value += w.x * w.y * w.z * voxel(base + step);
          }
        }
        const glm::ivec3 cell = glm::min(glm::ivec3(unit * dvec3(bounds.cells)), bounds.cells - 1);
        const double bound = bounds.values[static_cast<size_t>((cell.z * bounds.cells.y + cell.y) * bounds.cells.x + cell.x)];
        ASSERT_GE(bound * (1 + 1e-12), value);  // the weights may add up to a rounding more than 1
        tight += bound < 1;
      }
      EXPECT_GT(tight, 2000u);  // the bounds are not simply the largest value
    }
}

}  // namespace
}  // namespace tachylite::test
