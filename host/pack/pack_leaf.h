#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"
#include "shared/material.h"

namespace tachylite {

/// The rows of one leaf after its header, and what they ask of a kernel.
struct PackedLeaf {
  uint32_t type = 0, options = 0;  // kBsdf..., kOption...
  uint32_t flags = 0;              // kMaterial... that the leaf asks for
  uint32_t textured = 0;           // set of the inputs that are textures
  bool scatters = true;            // false: f is 0 everywhere
  std::vector<glm::uvec4> rows;
};

/// A row of constants: four floats by their bits.
inline glm::uvec4 float_row(double x, double y = 0, double z = 0, double w = 0) {
  auto bits = [](double v) { return std::bit_cast<uint32_t>(static_cast<float>(v)); };
  return {bits(x), bits(y), bits(z), bits(w)};
}

/// The row of an input. texture_row: kNoTexture for a constant.
inline glm::uvec4 input_row(const dvec3& value, uint32_t texture_row) {
  glm::uvec4 row = float_row(value.x, value.y, value.z);
  row.w = texture_row;
  return row;
}

/// A bsdf that scatters by itself (no adapter, not `null`) as a leaf; no value: it is exactly `null` (a dielectric
/// whose index matches).
std::optional<PackedLeaf> pack_leaf(const Bsdf& bsdf, std::span<const uint32_t> row_of_texture);

}  // namespace tachylite
