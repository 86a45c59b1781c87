// Area lights on disks and ellipses: uniform in area.
#ifndef TACHYLITE_LIGHT_DISK_GLSL
#define TACHYLITE_LIGHT_DISK_GLSL
#include "base/warp.glsl"
#include "light/record.glsl"

// centre: relative to p. st = position in the unit disk.
LightPoint sample_disk(vec3 centre, vec3 e1, vec3 e2, vec3 n, float area, vec2 u) {
  vec2 q = sample_uniform_disk(u);
  vec3 to = centre + q.x * e1 + q.y * e2;
  return LightPoint(to, n, pdf_of_area(area, to, n), q);
}

#endif
