// Area lights on cylinders without caps, also sheared and elliptic ones: uniform in the angle and the height of the
// unit cylinder, the angle within the part that faces p.
#ifndef TACHYLITE_LIGHT_CYLINDER_GLSL
#define TACHYLITE_LIGHT_CYLINDER_GLSL
#include "base/math.glsl"
#include "base/warp.glsl"
#include "light/record.glsl"

struct CylinderView {
  vec3 base, e1, e2, axis;  // base: relative to p
  vec2 towards;             // unit, of p in the frame of the unit cylinder
  float half_angle;         // of the visible part; pi for all of it
};

CylinderView view_cylinder(vec3 base, vec3 e1, vec3 e2, vec3 axis, bool inward) {
  CylinderView v;
  v.base = base;
  v.e1 = e1;
  v.e2 = e2;
  v.axis = axis;
  // -base = x e1 + y e2 + z axis, by Cramer's rule.
  vec3 a = cross(e2, axis), b = cross(axis, e1);
  vec2 q = -vec2(dot(base, a) / dot(e1, a), dot(base, b) / dot(e2, b));
  float rho = length(q);
  bool outside = rho > 1.0;
  v.towards = outside ? q / rho : vec2(1.0, 0.0);
  // From outside the part with cos > 1 / rho faces p; the inner side is seen from within, or through the ends.
  v.half_angle = outside && !inward ? xacos(1.0 / rho) : kPi;
  return v;
}

// d area / (d angle d height) at (cos, sin) of the angle; its direction is the outward normal's.
vec3 cylinder_area_vector(CylinderView v, vec2 cs) { return cross(cs.x * v.e2 - cs.y * v.e1, v.axis); }

float pdf_cylinder(CylinderView v, vec3 to, vec2 cs) {
  vec3 jacobian = cylinder_area_vector(v, cs);
  float d2 = dot(to, to), cosine = abs(dot(jacobian, to));  // times |jacobian|
  return cosine > 0.0 && v.half_angle > 0.0 ? d2 * sqrt(d2) / (2.0 * v.half_angle * cosine) : 0.0;
}

// At a hit: the point's angle is found from its position.
float pdf_cylinder_hit(CylinderView v, vec3 to) {
  vec3 a = cross(v.e2, v.axis), b = cross(v.axis, v.e1), q = to - v.base;
  vec2 cs = normalize(vec2(dot(q, a) / dot(v.e1, a), dot(q, b) / dot(v.e2, b)));
  // Beyond the visible part (p inside an outward cylinder): never sampled.
  bool visible = v.half_angle >= kPi || dot(cs, v.towards) > 0.0;
  return visible ? pdf_cylinder(v, to, cs) : 0.0;
}

// Whether the wall hides the point at the angle (cos, sin) and height z from p, as it does where p looks from outside at
// the inner side, but not through an end. Shadow rays cannot tell: they ignore the cylinder that they go to.
bool is_behind_wall(CylinderView v, vec2 cs, float z) {
  vec3 a = cross(v.e2, v.axis), b = cross(v.axis, v.e1), c = cross(v.e1, v.e2);
  vec2 q = -vec2(dot(v.base, a) / dot(v.e1, a), dot(v.base, b) / dot(v.e2, b));
  float height = -dot(v.base, c) / dot(v.axis, c);
  vec2 d = cs - q;
  // Where the segment first meets the infinite cylinder; the other root is 1. Points on the wall itself, which rounding
  // may put outside, see the inner side from within.
  const float kOnWall = 1e-3;
  float outside = dot(q, q) - 1.0, t = outside / dot(d, d), crossing = height + t * (z - height);
  return outside > kOnWall && t < 1.0 && crossing >= 0.0 && crossing <= 1.0;
}

LightPoint sample_cylinder(CylinderView v, bool inward, vec2 u) {
  float angle = (2.0 * u.x - 1.0) * v.half_angle;
  vec2 turn = vec2(cos(angle), sin(angle));
  vec2 cs = vec2(v.towards.x * turn.x - v.towards.y * turn.y, v.towards.y * turn.x + v.towards.x * turn.y);
  vec3 to = v.base + cs.x * v.e1 + cs.y * v.e2 + u.y * v.axis;
  vec3 n = normalize(cylinder_area_vector(v, cs));
  // The normal of a mirrored cylinder still points outwards.
  if (dot(n, cs.x * v.e1 + cs.y * v.e2) < 0.0) n = -n;
  float phi = has_light_textures ? xatan2(cs.y, cs.x) * kInvTwoPi : 0.0;
  float pdf = inward && is_behind_wall(v, cs, u.y) ? 0.0 : pdf_cylinder(v, to, cs);
  return LightPoint(to, inward ? -n : n, pdf, vec2(phi < 0.0 ? phi + 1.0 : phi, u.y));
}

#endif
