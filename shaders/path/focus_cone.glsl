// Directions towards a focuser (shared/guide.h): the cone in which its sphere is seen is the unit disk of the square
// [-1, 1]^2, which keeps solid angle. Corners of the square are directions around the cone.
#ifndef TACHYLITE_PATH_FOCUS_CONE_GLSL
#define TACHYLITE_PATH_FOCUS_CONE_GLSL
#include "base/features.glsl"
#include "base/frame.glsl"
#include "base/math.glsl"
#include "shared/guide.h"

struct FocusCone {
  Frame frame;  // n: towards the centre
  float omc;    // 1 - cos of the half angle
};

// Whether p is far enough outside of the sphere (centre, radius) for all of the square to be less than a half space.
bool sees_focuser(vec4 sphere, vec3 p) {
  vec3 d = sphere.xyz - p;
  return dot(d, d) > 1.4 * sphere.w * sphere.w;
}

// The square turns with the tangent, a function of the surface alone, so that it hardly turns within a cell.
FocusCone focus_cone(vec4 sphere, vec3 p, vec3 tangent) {
  vec3 d = sphere.xyz - p;
  float distance2 = max(dot(d, d), 1e-30), sin2 = min(sphere.w * sphere.w / distance2, 1.0);
  // Twice: where axis and tangent are nearly parallel, once leaves s not orthogonal enough for a narrow cone.
  vec3 axis = d * inversesqrt(distance2), s = frame_from_normal_tangent(axis, tangent).s;
  return FocusCone(frame_from_normal_tangent(axis, s), sin2 / (1.0 + sqrt(1.0 - sin2)));
}

// Density [1/sr] of directions that are uniform in the square.
float pdf_focus_cone(FocusCone cone) { return 0.125 / cone.omc; }

// u: uniform in [0, 1)^2.
vec3 focus_direction(FocusCone cone, vec2 u) {
  vec2 q = 2.0 * u - 1.0;
  float m = cone.omc * dot(q, q);  // 1 - cos
  return to_world(cone.frame, vec3(q * sqrt(cone.omc * (2.0 - m)), 1.0 - m));
}

// The numbers that give a world direction; outside of [0, 1]^2 for those that none gives.
vec2 focus_numbers(FocusCone cone, vec3 w) {
  vec3 v = to_local(cone.frame, w);
  vec2 q = v.xy * inversesqrt(max((1.0 + v.z) * cone.omc, 1e-30));
  return v.z > 0.0 ? 0.5 * q + 0.5 : vec2(-1.0);
}

bool is_in_square(vec2 u) { return min(u.x, u.y) >= 0.0 && max(u.x, u.y) <= 1.0; }

const uint kNoFocuser = kMaxFocusers;

// Takes focuser k with probability shares[k], else kNoFocuser, by a number that is uniform again after it.
uint choose_focuser(vec4 shares, inout float u) {
  uint chosen = kNoFocuser;
  float share = 1.0, begin = 0.0;
  for (uint k = 0u; k < focuser_count; ++k) share -= shares[k];
  float at = share;
  for (uint k = 0u; k < focuser_count; ++k) {
    if (u >= at && shares[k] > 0.0) {
      chosen = k;
      share = shares[k];
      begin = at;
    }
    at += shares[k];
  }
  u = clamp((u - begin) / share, 0.0, 0.999998);
  return chosen;
}

#endif
