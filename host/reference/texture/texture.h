#pragma once

// Texture lookups. A colour is a linear Rec.709 triple; a scalar asked of a three-channel texture is its
// luminance, taken of each texel before filtering (the same as after it, filtering being linear); the
// checkerboard swaps its colours as a scalar.

#include "reference/math.h"
#include "scene/scene.h"

namespace tachylite::reference {

/// Where a texture is looked up: uv, and the place on a mesh for the plugin mesh_attribute.
struct TextureCoordinates {
  dvec2 uv{0};
  const Mesh* mesh = nullptr;
  size_t triangle = 0;
  dvec3 barycentrics{1, 0, 0};
};

dvec3 eval_texture(const Scene& scene, TextureIndex texture, const TextureCoordinates& at);
/// d(scalar)/d(u, v) of the interpolated texels, through to_uv. Zero for nearest lookup and for other plugins, but for
/// bitmaps in the squares of a checkerboard.
dvec2 eval_texture_gradient(const Scene& scene, TextureIndex texture, const TextureCoordinates& at);

dvec3 eval_color(const Scene& scene, const ColorInput& input, const TextureCoordinates& at);
double eval_scalar(const Scene& scene, const ScalarInput& input, const TextureCoordinates& at);

}  // namespace tachylite::reference
