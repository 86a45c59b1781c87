// Area lights on triangles: uniform in area.
#ifndef TACHYLITE_LIGHT_TRIANGLE_GLSL
#define TACHYLITE_LIGHT_TRIANGLE_GLSL
#include "base/warp.glsl"
#include "light/record.glsl"

// v0: relative to p.
LightPoint sample_triangle(vec3 v0, vec3 e1, vec3 e2, vec3 n, float area, vec2 u) {
  vec2 b = sample_uniform_triangle(u).xy;
  vec3 to = v0 + b.x * e1 + b.y * e2;
  return LightPoint(to, n, pdf_of_area(area, to, n), b);
}

float pdf_triangle(vec3 n, float area, vec3 to) { return pdf_of_area(area, to, n); }

#endif
