// Textures: the switch over their kinds. A lookup is a row in kBindTextures and a TexturePoint.
#ifndef TACHYLITE_TEXTURE_TEXTURE_GLSL
#define TACHYLITE_TEXTURE_TEXTURE_GLSL
#include "base/color.glsl"
#include "base/features.glsl"
#include "geometry/interaction.glsl"
#include "shared/bindings.h"
#include "shared/texture.h"
#include "texture/attribute.glsl"
#include "texture/bitmap.glsl"
#include "texture/checkerboard.glsl"

layout(set = 0, binding = kBindTextures) uniform usamplerBuffer textures;

uvec4 load_texture(uint row) { return texelFetch(textures, int(row)); }

// Rows of to_uv: uv' = (m0 (u, v, 1), m1 (u, v, 1)).
struct TextureTransform {
  vec3 m0, m1;
};

TextureTransform load_texture_transform(uint row) {
  TextureTransform m = TextureTransform(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0));
  if (has_texture(kTexturesTransform)) {
    m.m0 = uintBitsToFloat(load_texture(row + 1u).xyz);
    m.m1 = uintBitsToFloat(load_texture(row + 2u).xyz);
  }
  return m;
}

vec2 transform_uv(TextureTransform m, vec2 uv) { return vec2(dot(m.m0, vec3(uv, 1.0)), dot(m.m1, vec3(uv, 1.0))); }

uvec4 load_checkerboard_square(uint row, vec2 uv, bool as_scalar) {
  return checkerboard_square(load_texture(row + 3u), load_texture(row + 4u), uv, as_scalar);
}

// The texture that is seen at a point: where a square of a checkerboard is a texture, that one. It is looked up at the
// same uv, by its own to_uv; that of the checkerboard says which square it is.
uint seen_texture(uint row, TexturePoint point, bool as_scalar) {
  if (has_texture(kTexturesNested)) {
    for (uint i = 0u; i < kMostCheckerboards; ++i) {
      if ((load_texture(row).x & kTextureKindMask) != kTextureCheckerboard) break;
      vec2 uv = transform_uv(load_texture_transform(row), point.uv);
      uint inside = load_checkerboard_square(row, uv, as_scalar).w;
      if (inside == 0u) break;
      row = inside - 1u;
    }
  }
  return row;
}

// Linear Rec.709. as_scalar: for a parameter that is a number.
vec3 texture_value(uint row, TexturePoint point, bool as_scalar) {
  row = seen_texture(row, point, as_scalar);
  uvec4 row0 = load_texture(row);
  uint kind = row0.x & kTextureKindMask;
  vec3 color = vec3(0.0);
  if (has_texture(kTexturesBitmap) || has_texture(kTexturesCheckerboard)) {
    vec2 uv = transform_uv(load_texture_transform(row), point.uv);
    if (has_texture(kTexturesBitmap) && kind == kTextureBitmap) color = bitmap_color(row0, uv);
    if (has_texture(kTexturesCheckerboard) && kind == kTextureCheckerboard)
      color = uintBitsToFloat(load_checkerboard_square(row, uv, as_scalar).xyz);
  }
  if (has_texture(kTexturesAttribute) && kind == kTextureAttribute)
    color = attribute_color(row0, uintBitsToFloat(load_texture(row + 3u).x), point.primitive, point.barycentrics);
  return color;
}

vec3 texture_color(uint row, TexturePoint point) { return texture_value(row, point, false); }
// A texture asked for a scalar answers with its luminance.
float texture_scalar(uint row, TexturePoint point) { return luminance(texture_value(row, point, true)); }

// (d scalar / du, d scalar / dv) of a bilinear bitmap, in the uv before to_uv; 0 for all others.
vec2 texture_scalar_gradient(uint row, TexturePoint point) {
  row = seen_texture(row, point, true);
  uvec4 row0 = load_texture(row);
  vec2 gradient = vec2(0.0);
  if (has_texture(kTexturesBitmap) && has_texture(kTexturesBilinear) &&
      (row0.x & kTextureKindMask) == kTextureBitmap) {
    TextureTransform m = load_texture_transform(row);
    vec2 g = bitmap_gradient(row0, transform_uv(m, point.uv));
    gradient = vec2(m.m0.x * g.x + m.m1.x * g.y, m.m0.y * g.x + m.m1.y * g.y);
  }
  return gradient;
}

#endif
