// Lights at a point with a profile: spot and projector. Both look along +z of their own frame.
#ifndef TACHYLITE_LIGHT_SPOT_GLSL
#define TACHYLITE_LIGHT_SPOT_GLSL
#include "base/math.glsl"
#include "light/record.glsl"

struct PointFrame {
  vec3 position;
  vec3 x, y, z;  // rows: world -> light
};

PointFrame load_point_frame(uint light) {
  vec4 a = load_light(light + 1u), b = load_light(light + 2u), c = load_light(light + 3u);
  return PointFrame(vec3(a.w, b.w, c.w), a.xyz, b.xyz, c.xyz);
}

vec3 to_point_frame(PointFrame frame, vec3 v) { return vec3(dot(frame.x, v), dot(frame.y, v), dot(frame.z, v)); }

// Linear in the angle between the beam width and the cutoff. local: direction of light, of any length.
// profile: cos cutoff, cutoff, cos beam width, 1 / (cutoff - beam width).
float spot_falloff(vec4 profile, vec3 local) {
  float cosine = local.z * inversesqrt(dot(local, local));
  float angle = xatan2(length(local.xy), local.z);  // acos(cosine) would lose the digits of small angles
  float ramp = cosine >= profile.z ? 1.0 : (profile.y - angle) * profile.w;
  return cosine > profile.x ? clamp(ramp, 0.0, 1.0) : 0.0;
}

vec2 spot_uv(vec3 local, float tan_cutoff) { return 0.5 + 0.5 * local.xy / (local.z * tan_cutoff); }

// scale: 1 / tan(fov / 2) of x and y. Like a camera's film: u falls with x, which points left.
vec2 projector_uv(vec3 local, vec2 scale) { return 0.5 - 0.5 * scale * local.xy / local.z; }

// Irradiance 1 on the plane z = 1 when multiplied by the cosine there: pi / (z^2 cos theta).
float projector_falloff(vec3 local, vec2 uv) {
  bool inside = local.z > 0.0 && uv == clamp(uv, 0.0, 1.0);
  float z2 = local.z * local.z;
  return inside ? kPi * length(local) / (z2 * local.z) : 0.0;
}

#endif
