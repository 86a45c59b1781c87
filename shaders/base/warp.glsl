// Maps of the unit square, u in [0, 1)^2, to simple domains. Each sample_ has its density beside it, with the measure
// it is taken with respect to. Local directions have z along the normal or axis.
#ifndef TACHYLITE_BASE_WARP_GLSL
#define TACHYLITE_BASE_WARP_GLSL

#include "math.glsl"

/// The unit disk, concentric squares to concentric circles: Shirley and Chiu 1997, "A Low Distortion Map Between Disk
/// and Square". (x, y, radius).
vec3 sample_disk_polar(vec2 u) {
  const vec2 a = 2.0 * u - 1.0;
  const bool wide = abs(a.x) > abs(a.y);
  const float r = wide ? a.x : a.y;  // signed: the opposite wedge is a half turn away
  const float across = wide ? a.y : a.x;
  const vec2 cs = cos_sin_eighth(0.125 * across / (r == 0.0 ? 1.0 : r));
  return vec3(r * (wide ? cs : cs.yx), abs(r));
}
vec2 sample_uniform_disk(vec2 u) { return sample_disk_polar(u).xy; }
/// W.r.t. area of the unit disk.
float pdf_uniform_disk() { return kInvPi; }

/// Density proportional to the cosine to z. z may be 0 (then the density is 0, too): weight samples by a closed form,
/// never by f / pdf.
vec3 sample_cosine_hemisphere(vec2 u) {
  const vec3 d = sample_disk_polar(u);
  return vec3(d.xy, sqrt((1.0 - d.z) * (1.0 + d.z)));
}
/// W.r.t. solid angle [1/sr]; 0 below the horizon.
float pdf_cosine_hemisphere(float cos_theta) { return max(cos_theta, 0.0) * kInvPi; }

vec3 sample_uniform_sphere(vec2 u) {
  const float r = 2.0 * sqrt(u.x * (1.0 - u.x));
  return vec3(r * cos_sin_turns(u.y), 1.0 - 2.0 * u.x);
}
/// W.r.t. solid angle [1/sr].
float pdf_uniform_sphere() { return kInvFourPi; }

vec3 sample_uniform_hemisphere(vec2 u) {
  const float r = sqrt(u.x * (2.0 - u.x));
  return vec3(r * cos_sin_turns(u.y), 1.0 - u.x);
}
/// W.r.t. solid angle [1/sr], above the horizon.
float pdf_uniform_hemisphere() { return kInvTwoPi; }

/// Barycentric coordinates (b0, b1, b2): Heitz 2019, "A Low-Distortion Map Between Triangle and Square". Uniform in
/// area: the density is 1 / area.
vec3 sample_uniform_triangle(vec2 u) {
  const vec2 b = u.y > u.x ? vec2(0.5 * u.x, u.y - 0.5 * u.x) : vec2(u.x - 0.5 * u.y, 0.5 * u.y);
  return vec3(b, 1.0 - b.x - b.y);
}
/// W.r.t. area [1/m^2].
float pdf_uniform_triangle(float area) { return 1.0 / area; }

/// Directions within a cone about z. `omc` = 1 - cos of its half angle, which keeps its digits for narrow cones:
/// sin^2 / (1 + sqrt(1 - sin^2)).
vec3 sample_uniform_cone(vec2 u, float omc) {
  const float one_minus_cos = u.x * omc;
  const float sin_theta = sqrt(one_minus_cos * (2.0 - one_minus_cos));
  return vec3(sin_theta * cos_sin_turns(u.y), 1.0 - one_minus_cos);
}
/// W.r.t. solid angle [1/sr], inside the cone.
float pdf_uniform_cone(float omc) { return kInvTwoPi / omc; }
float one_minus_cos_of_sin2(float sin2) { return sin2 / (1.0 + sqrt(max(1.0 - sin2, 0.0))); }

#endif
