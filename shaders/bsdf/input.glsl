// Access to the rows of materials (shared/material.h), and the inputs of leaves: constants or textures.
#ifndef TACHYLITE_BSDF_INPUT_GLSL
#define TACHYLITE_BSDF_INPUT_GLSL
#include "base/features.glsl"
#include "shared/bindings.h"
#include "shared/material.h"
#ifdef BSDF_NO_TEXTURES
#include "geometry/interaction.glsl"
#else
#include "texture/texture.glsl"
#endif

// Textures of inputs; code that does not know of them has none (BSDF_NO_TEXTURES).
#ifdef BSDF_NO_TEXTURES
vec3 input_color(uint row, TexturePoint point) { return vec3(0.0); }
float input_scalar(uint row, TexturePoint point) { return 0.0; }
vec2 input_gradient(uint row, TexturePoint point) { return vec2(0.0); }
#else
vec3 input_color(uint row, TexturePoint point) { return texture_color(row, point); }
float input_scalar(uint row, TexturePoint point) { return texture_scalar(row, point); }
vec2 input_gradient(uint row, TexturePoint point) { return texture_scalar_gradient(row, point); }
#endif

float mean(vec3 v) { return (v.x + v.y + v.z) * (1.0 / 3.0); }

layout(set = 0, binding = kBindMaterials) uniform usamplerBuffer material_rows;

uvec4 load_material_row(uint row) { return texelFetch(material_rows, int(row)); }
vec4 load_material_floats(uint row) { return uintBitsToFloat(load_material_row(row)); }

// Row number `index` after the header of the leaf that begins at row `leaf`. `index` must be a constant: then a class
// in which that input is never a texture has no texture code for it.
vec3 load_color(uint leaf, uint index, TexturePoint point) {
  uvec4 row = load_material_row(leaf + 1u + index);
  vec3 value = uintBitsToFloat(row.xyz);
  if (has_textured_input(1u << index) && row.w != kNoTexture) value = input_color(row.w, point);
  return value;
}
// Two scalars in one row: values in x and y, texture rows in z and w.
vec2 load_scalar_pair(uint leaf, uint index, TexturePoint point) {
  uvec4 row = load_material_row(leaf + 1u + index);
  vec2 value = uintBitsToFloat(row.xy);
  if (has_textured_input(1u << index)) {
    if (row.z != kNoTexture) value.x = input_scalar(row.z, point);
    if (row.w == row.z) value.y = value.x;
    else if (row.w != kNoTexture) value.y = input_scalar(row.w, point);
  }
  return value;
}
// Four scalars: values in row `index`, texture rows in row `index + 1`.
vec4 load_scalar_quad(uint leaf, uint index, TexturePoint point) {
  vec4 value = load_material_floats(leaf + 1u + index);
  if (has_textured_input(1u << index)) {
    uvec4 row = load_material_row(leaf + 2u + index);
    if (row.x != kNoTexture) value.x = input_scalar(row.x, point);
    if (row.y != kNoTexture) value.y = input_scalar(row.y, point);
    if (row.z != kNoTexture) value.z = input_scalar(row.z, point);
    if (row.w != kNoTexture) value.w = input_scalar(row.w, point);
  }
  return value;
}
// Four floats.
vec4 load_constants(uint leaf, uint index) { return load_material_floats(leaf + 1u + index); }

// Product of the weights of the leaf whose header (its row 0) is `header`; in [0, 1].
float load_leaf_weight(uint leaf, uvec4 header, TexturePoint point) {
  uint count = header.y & 0xffffu;
  uint first = leaf + (header.y >> 16u);
  float product = 1.0;
  for (uint i = 0u; i < count; ++i) {
    uvec4 row = load_material_row(first + i);
    float value = uintBitsToFloat(row.x);
    uint texture_row = row.w & kNoTexture;
    if (has_textured_input(kTexturedWeights) && texture_row != kNoTexture) value = input_scalar(texture_row, point);
    value = clamp(value, 0.0, 1.0);
    product *= (row.w & kInputComplement) != 0u ? 1.0 - value : value;
  }
  return product;
}

#endif
