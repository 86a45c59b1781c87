// Paths of thousands of edges that lose nothing: their sum is known to rounding.

#include <cmath>

#include <fmt/format.h>

#include "stress/stress_case.h"
#include "support/vol_file.h"

namespace tachylite::test {
namespace {

using LongPaths = DeviceTest;

TEST_F(LongPaths, FiveThousandBouncesInAWhiteRoom) {
  // White walls that emit 2^-12: an edge adds 2^-12, and sums of them are exact.
  constexpr int kDepth = 5000;
  Scene scene = scene_from_elements(fmt::format(R"(<integrator type="path"><integer name="max_depth" value="{}"/>
<integer name="rr_depth" value="1000000"/></integrator>)", kDepth) +
      sensor_element(4, 4, "0.2, 0.1, 0.5", "0, 0, 0", 60) + R"(<shape type="cube">
<boolean name="flip_normals" value="true"/><bsdf type="diffuse"><float name="reflectance" value="1"/></bsdf>
<emitter type="area"><float name="radiance" value="0.000244140625"/></emitter></shape>)");
  scene.integrator.strategy = Integrator::Strategy::kBsdfOnly;
  expect_stress(scene, {.name = "5000 bounces in a white room", .samples = 1, .bound = 1e-6,
                        .error = worst_pixel(std::ldexp(kDepth, -12))});
}

TEST_F(LongPaths, WhiteGridOfZerosOnesAndSpikes) {
  // 5^3 voxels of 0 and 1 and, in a checkerboard of every second one, 1e4: an optical depth of 40 across each.
  constexpr int kVoxels = 5;
  std::vector<float> values;
  for (int z = 0; z < kVoxels; ++z)
    for (int y = 0; y < kVoxels; ++y)
      for (int x = 0; x < kVoxels; ++x)
        values.push_back(x % 2 && y % 2 && z % 2 ? 1e4f : static_cast<float>((x + y + z) % 2));
  for (const char* filter : {"nearest", "trilinear"})
    expect_stress(scene_from_elements(R"(<integrator type="volpath"><integer name="max_depth" value="-1"/>
<integer name="rr_depth" value="1000000"/></integrator>)" + sensor_element(8, 8, "0, 0, 5", "0, 0, 0", 24) +
        fmt::format(R"(<shape type="cube"><bsdf type="null"/><medium name="interior" type="heterogeneous">
<float name="scale" value="0.01"/><float name="albedo" value="1"/><volume name="sigma_t" type="gridvolume">
<string name="filename" value="grid.vol"/><string name="filter_type" value="{}"/><transform name="to_world">
<translate value="-0.5, -0.5, -0.5"/><scale value="2"/></transform></volume></medium></shape>
<emitter type="constant"><float name="radiance" value="1"/></emitter>)", filter),
        {{"grid.vol", vol_file(glm::ivec3(kVoxels), 1, values)}}),
                  {.name = fmt::format("white grid of 0, 1 and 1e4, {}", filter), .samples = 4, .bound = 1e-6,
                   .error = worst_pixel(1), .reference_error = mean_beyond_noise(glm::dvec3(1))});
}

}  // namespace
}  // namespace tachylite::test
