// Checkerboard: color0 where exactly one of frac(u), frac(v) exceeds 1/2, color1 elsewhere.
#ifndef TACHYLITE_TEXTURE_CHECKERBOARD_GLSL
#define TACHYLITE_TEXTURE_CHECKERBOARD_GLSL

vec3 checkerboard_color(uvec4 color0, uvec4 color1, vec2 uv) {
  bvec2 upper = greaterThan(uv - floor(uv), vec2(0.5));
  return uintBitsToFloat(upper.x != upper.y ? color0.xyz : color1.xyz);
}

#endif
