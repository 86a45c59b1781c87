// Checkerboard. As a colour: color0 where frac(u) and frac(v) lie on the same side of 1/2, color1 elsewhere; as a
// scalar the other way round. So Mitsuba 3.7 does it, as its images show.
#ifndef TACHYLITE_TEXTURE_CHECKERBOARD_GLSL
#define TACHYLITE_TEXTURE_CHECKERBOARD_GLSL

// Which of the rows color0 and color1 the point uv falls on.
uvec4 checkerboard_square(uvec4 color0, uvec4 color1, vec2 uv, bool as_scalar) {
  bvec2 upper = greaterThan(uv - floor(uv), vec2(0.5));
  return (upper.x == upper.y) != as_scalar ? color0 : color1;
}

#endif
