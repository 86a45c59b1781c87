// Access to the rows of materials (shared/material.h), and the inputs of leaves: constants or textures.
#ifndef TACHYLITE_BSDF_INPUT_GLSL
#define TACHYLITE_BSDF_INPUT_GLSL
#include "base/features.glsl"
#include "shared/bindings.h"
#include "shared/material.h"
#include "texture/texture.glsl"

layout(set = 0, binding = kBindMaterials) uniform usamplerBuffer material_rows;

uvec4 load_material_row(uint row) { return texelFetch(material_rows, int(row)); }
vec4 load_material_floats(uint row) { return uintBitsToFloat(load_material_row(row)); }

// Input number `index` of the leaf that begins at row `leaf`. `index` must be a constant: then a class in which that
// input is never a texture has no texture code for it.
vec3 load_color(uint leaf, uint index, TexturePoint point) {
  uvec4 row = load_material_row(leaf + 1u + index);
  vec3 value = uintBitsToFloat(row.xyz);
  if (has_textured_input(1u << index) && row.w != kNoTexture) value = texture_color(row.w, point);
  return value;
}
float load_scalar(uint leaf, uint index, TexturePoint point) {
  uvec4 row = load_material_row(leaf + 1u + index);
  float value = uintBitsToFloat(row.x);
  if (has_textured_input(1u << index) && row.w != kNoTexture) value = texture_scalar(row.w, point);
  return value;
}

// Product of the weights of the leaf whose header (its row 0) is `header`; in [0, 1].
float load_leaf_weight(uint leaf, uvec4 header, TexturePoint point) {
  uint count = header.y & 0xffffu;
  uint first = leaf + (header.y >> 16u);
  float product = 1.0;
  for (uint i = 0u; i < count; ++i) {
    uvec4 row = load_material_row(first + i);
    float value = uintBitsToFloat(row.x);
    uint texture_row = row.w & kNoTexture;
    if (has_textured_input(kTexturedWeights) && texture_row != kNoTexture) value = texture_scalar(texture_row, point);
    value = clamp(value, 0.0, 1.0);
    product *= (row.w & kInputComplement) != 0u ? 1.0 - value : value;
  }
  return product;
}

#endif
