// Bitmaps: texel centres at (i + 0.5) / resolution, v = 0 at the first (top) row; wrapping acts on texel indices.
#ifndef TACHYLITE_TEXTURE_BITMAP_GLSL
#define TACHYLITE_TEXTURE_BITMAP_GLSL
#include "base/color.glsl"
#include "base/features.glsl"
#include "shared/bindings.h"
#include "shared/texture.h"

layout(set = 0, binding = kBindTexels8) uniform samplerBuffer texels8;
layout(set = 0, binding = kBindTexels16) uniform samplerBuffer texels16;
layout(set = 0, binding = kBindTexels32) uniform samplerBuffer texels32;

// IEC 61966-2-1: c / 12.92 up to 0.04045, ((c + 0.055) / 1.055)^2.4 above. The power is s^3 times a minimax
// polynomial in s = sqrt((c + 0.055) / 1.055), fitted to the 245 bytes above the linear part; relative error 1.2e-6,
// exact at 0 and 1.
vec3 decode_srgb(vec3 c) {
  vec3 s = sqrt(c * (1.0 / 1.055) + 0.055 / 1.055);
  vec3 g = 0.330722809 + s * (-0.151673853 + s * 0.0312348381);
  g = -0.00258781458 + s * (0.0656590089 + s * (1.19747269 + s * (-0.470827699 + s * g)));
  return mix(s * s * s * g, c * (1.0 / 12.92), lessThanEqual(c, vec3(0.04045)));
}

// Linear colour of one texel.
vec3 load_texel(uint format, uint index) {
  vec3 color = vec3(0.0);
  if (has_texture(kTextures8Srgb) || has_texture(kTextures8Linear)) {
    if (format == kTexel8Srgb || format == kTexel8Linear) {
      color = texelFetch(texels8, int(index)).rgb;
      if (has_texture(kTextures8Srgb) && format == kTexel8Srgb) color = decode_srgb(color);
    }
  }
  if (has_texture(kTexturesHalf) && format == kTexelHalf) color = texelFetch(texels16, int(index)).rgb;
  if (has_texture(kTexturesFloat) && format == kTexelFloat) color = texelFetch(texels32, int(index)).rgb;
  return color;
}

// The texels around a point along one axis: weight of `hi` is w, of `lo` 1 - w; slope = d (texel position) / d u.
struct TexelPair {
  uint lo, hi;
  float w, slope;
};

TexelPair texel_pair(float u, uint size, uint wrap, bool nearest) {
  // The coordinate within the image, in [0, 1].
  bool mirror = has_texture(kTexturesMirror) && wrap == kWrapMirror;
  bool clamped = has_texture(kTexturesClamp) && wrap == kWrapClamp;
  float period = mirror ? 2.0 : 1.0;
  float folded = u - period * floor(u / period);
  bool turned = mirror && folded > 1.0;
  float m = clamped ? u : (turned ? 2.0 - folded : folded);
  m = clamp(m, 0.0, 1.0);  // also 0 for NaN

  float n = float(size), x = m * n - (nearest ? 0.0 : 0.5);
  int lo = int(floor(x)), last = int(size) - 1;
  TexelPair pair;
  pair.w = nearest ? 0.0 : x - floor(x);
  pair.slope = nearest || (clamped && m != u) ? 0.0 : (turned ? -n : n);
  bool repeat = !mirror && !clamped;
  int hi = nearest ? lo : lo + 1;
  if (nearest) lo = hi = min(lo, last);
  pair.lo = uint(lo < 0 ? (repeat ? last : 0) : lo);
  pair.hi = uint(hi > last ? (repeat ? 0 : last) : hi);
  return pair;
}

struct TexelQuad {
  vec3 c00, c10, c01, c11;  // c[x][y]
  vec2 w, slope;
};

TexelQuad load_texel_quad(uvec4 row0, vec2 uv) {
  uint format = (row0.x >> kTextureFormatShift) & 0xfu;
  uint wrap = (row0.x >> kTextureWrapShift) & 0xfu;
  bool nearest = !has_texture(kTexturesBilinear) ||
                 (has_texture(kTexturesNearest) && ((row0.x >> kTextureFilterShift) & 0xfu) == kFilterNearest);
  TexelPair x = texel_pair(uv.x, row0.z, wrap, nearest), y = texel_pair(uv.y, row0.w, wrap, nearest);
  TexelQuad quad;
  uint lo = row0.y + y.lo * row0.z, hi = row0.y + y.hi * row0.z;
  quad.c00 = load_texel(format, lo + x.lo);
  if (has_texture(kTexturesBilinear)) {
    quad.c10 = load_texel(format, lo + x.hi);
    quad.c01 = load_texel(format, hi + x.lo);
    quad.c11 = load_texel(format, hi + x.hi);
  } else {
    quad.c10 = quad.c01 = quad.c11 = quad.c00;
  }
  quad.w = vec2(x.w, y.w);
  quad.slope = vec2(x.slope, y.slope);
  return quad;
}

vec3 bitmap_color(uvec4 row0, vec2 uv) {
  TexelQuad q = load_texel_quad(row0, uv);
  return mix(mix(q.c00, q.c10, q.w.x), mix(q.c01, q.c11, q.w.x), q.w.y);
}

// d luminance / d uv of the bilinear interpolant; 0 for nearest.
vec2 bitmap_gradient(uvec4 row0, vec2 uv) {
  TexelQuad q = load_texel_quad(row0, uv);
  vec3 du = mix(q.c10 - q.c00, q.c11 - q.c01, q.w.y), dv = mix(q.c01 - q.c00, q.c11 - q.c10, q.w.x);
  return q.slope * vec2(luminance(du), luminance(dv));
}

#endif
