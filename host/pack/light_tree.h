#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace tachylite {

/// Where a light or a group of lights is, where it shines, and how much (shared/light.h): the sphere is that of the
/// box; normals lie within theta_o of the axis, light within theta_e of its normal.
struct LightBounds {
  glm::dvec3 box_min{0}, box_max{0};
  glm::dvec3 axis{0, 0, 1};
  double theta_o = 0, theta_e = 0;  // radians
  double power = 0;                 // estimated irradiance at distance d is power / (d^2 + radius^2)
  double radius = -1;               // of the sphere around the box's centre; < 0: half the box's diagonal
};

LightBounds merge(const LightBounds& a, const LightBounds& b);

/// The three rows of a unit or node. child: light row, or kLightNode | row.
void append_light_bounds(const LightBounds& bounds, uint32_t child, std::vector<glm::uvec4>& rows);

/// A binary tree over lights, split by the surface area orientation heuristic: Conty Estevez and Kulla 2018,
/// "Importance Sampling of Many Lights with Adaptive Tree Splitting", section 4.4.
struct LightTree {
  LightBounds root;
  uint32_t root_child = 0;          // of the root's unit, as append_light_bounds takes it
  std::vector<uint32_t> trails;     // for each light: bit k says which child is taken at depth k
};

/// `rows_of_lights`: light row of each. Nodes are appended to `table`. At least one light; none deeper than 32.
LightTree build_light_tree(std::span<const LightBounds> lights, std::span<const uint32_t> rows_of_lights,
                           std::vector<glm::uvec4>& table);

}  // namespace tachylite
