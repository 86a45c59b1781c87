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

/// The three rows of a unit or of a node's child. child: light row, or a node (shared/light.h).
void append_light_bounds(const LightBounds& bounds, uint32_t child, std::vector<glm::uvec4>& table);

/// Appends a tree over lights to the table: up to kLightNodeWidth units, then the nodes below them. The table holds
/// its header and `first_unit` other units so far. It is a binary tree, split by the surface area orientation heuristic
/// (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting", section 4.4),
/// collapsed to wide nodes by opening the child of largest power times size.
/// lights: at least one; rows: light row of each. Returns for each where it is (row 5 of its record).
std::vector<glm::uvec2> append_light_tree(std::span<const LightBounds> lights, std::span<const uint32_t> rows,
                                          uint32_t first_unit, std::vector<glm::uvec4>& table);

}  // namespace tachylite
