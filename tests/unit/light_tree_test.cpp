// Light trees: every light is reached by the trail that its record holds, and nodes bound what is below them.

#include <bit>
#include <random>

#include <gtest/gtest.h>

#include "pack/light_tree.h"
#include "shared/light.h"

namespace tachylite {
namespace {

using glm::dvec3;

float as_float(uint32_t bits) { return std::bit_cast<float>(bits); }

struct Row {
  dvec3 centre;
  double radius, power;
  uint32_t child;
};

Row row_at(const std::vector<glm::uvec4>& table, uint32_t number) {
  const glm::uvec4* r = &table[gpu::kLightTableHeaderRows + gpu::kLightNodeRows * number];
  return {dvec3(as_float(r[0].x), as_float(r[0].y), as_float(r[0].z)), as_float(r[0].w), as_float(r[1].w), r[2].w};
}

std::vector<LightBounds> random_lights(size_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<LightBounds> lights(count);
  for (LightBounds& b : lights) {
    const dvec3 c(10 * u(random), 10 * u(random), 3 * u(random)), half(0.1 * (1.1 + u(random)));
    b.box_min = c - half;
    b.box_max = c + half;
    b.axis = glm::normalize(dvec3(u(random), u(random), u(random)));
    b.theta_e = 1.57;
    b.power = std::pow(10.0, 4 * u(random));
  }
  return lights;
}

TEST(LightTree, TrailsLeadToTheirLights) {
  for (const size_t count : {1, 2, 8, 9, 100, 20000}) {
    std::vector<LightBounds> lights = random_lights(count, 3);
    // Many in one place: no split separates them.
    for (size_t i = 0; i < count / 4; ++i) lights[i] = lights[0];
    std::vector<uint32_t> rows(count);
    for (size_t i = 0; i < count; ++i) rows[i] = static_cast<uint32_t>(gpu::kLightRows * i);
    // One unit is there before.
    std::vector<glm::uvec4> table(gpu::kLightTableHeaderRows + gpu::kLightNodeRows);
    const std::vector<glm::uvec2> where = append_light_tree(lights, rows, 1, table);
    ASSERT_EQ(where.size(), count);
    double power = 0;
    for (uint32_t unit = 1; unit < 1 + std::min<size_t>(count, gpu::kLightNodeWidth); ++unit)
      power += row_at(table, unit).power;
    double exact = 0;
    for (const LightBounds& b : lights) exact += b.power;
    EXPECT_NEAR(power / exact, 1, 1e-5);

    for (size_t i = 0; i < count; ++i) {
      Row row = row_at(table, where[i].x & 0xffu);
      uint32_t trail = where[i].x >> 8, levels = 0;
      const dvec3 centre = 0.5 * (lights[i].box_min + lights[i].box_max);
      while ((row.child & gpu::kLightNode) != 0) {
        EXPECT_LE(glm::length(centre - row.centre), row.radius);
        EXPECT_GE(row.power, lights[i].power * 0.999999);
        const uint32_t children = ((row.child >> gpu::kLightNodeCountShift) & (gpu::kLightNodeWidth - 1)) + 1;
        ASSERT_LT(trail & 7u, children);
        row = row_at(table, (row.child & gpu::kLightNodeFirstMask) + (trail & 7u));
        trail = ++levels == 8 ? where[i].y : trail >> 3;
        ASSERT_LE(levels, gpu::kLightTrailLevels);
      }
      ASSERT_EQ(row.child, rows[i]);
    }
  }
}

TEST(LightTree, MergedBoundsHoldBoth) {
  const std::vector<LightBounds> lights = random_lights(200, 9);
  for (size_t i = 0; i + 1 < lights.size(); i += 2) {
    const LightBounds m = merge(lights[i], lights[i + 1]);
    for (const LightBounds* b : {&lights[i], &lights[i + 1]}) {
      EXPECT_LE(std::acos(std::min(1.0, glm::dot(m.axis, b->axis))), m.theta_o + 1e-6);
      EXPECT_TRUE(glm::all(glm::lessThanEqual(m.box_min, b->box_min)));
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(m.box_max, b->box_max)));
    }
    EXPECT_EQ(m.power, lights[i].power + lights[i + 1].power);
  }
}

}  // namespace
}  // namespace tachylite
