// Area lights on spheres. From outside: uniform in the cone that the sphere subtends; from inside (where only a
// sphere with flipped normals shines): uniform over all directions.
#ifndef TACHYLITE_LIGHT_SPHERE_GLSL
#define TACHYLITE_LIGHT_SPHERE_GLSL
#include "base/frame.glsl"
#include "base/math.glsl"
#include "base/warp.glsl"
#include "light/record.glsl"

// Closer to the surface than this times the radius counts as inside, where the cone is a half space.
const float kSphereMargin = 1e-5;

bool outside_sphere(vec3 centre, float radius) {
  float limit = radius * (1.0 + kSphereMargin);
  return dot(centre, centre) > limit * limit;
}

// centre: relative to p. inward: 1 for flipped normals.
float pdf_sphere(vec3 centre, float radius, bool inward) {
  if (outside_sphere(centre, radius))
    return inward ? 0.0 : pdf_uniform_cone(one_minus_cos_of_sin2(radius * radius / dot(centre, centre)));
  return inward ? pdf_uniform_sphere() : 0.0;
}

LightPoint sample_sphere(vec3 centre, float radius, bool inward, vec2 u) {
  float d2 = dot(centre, centre), d = sqrt(d2);
  bool outside = outside_sphere(centre, radius);
  vec3 axis = d > 0.0 ? centre / d : vec3(0.0, 0.0, 1.0);
  vec3 local = outside ? sample_uniform_cone(u, one_minus_cos_of_sin2(radius * radius / d2)) : sample_uniform_sphere(u);
  vec3 wi = to_world(frame_from_normal(axis), local);
  // The near intersection from outside, the far one from inside; the squared distance of the ray from the centre is
  // d^2 sin^2 without 1 - cos^2.
  float sin2 = dot(local.xy, local.xy), half_chord = safe_sqrt(radius * radius - d2 * sin2);
  float t = outside ? d * local.z - half_chord : d * local.z + half_chord;
  vec3 to = max(t, 0.0) * wi;
  vec3 n = normalize(to - centre);
  return LightPoint(to, inward ? -n : n, pdf_sphere(centre, radius, inward), vec2(0.0));
}

// (phi / 2 pi, theta / pi) of a point, from the centre. x_axis: unit, w = -1 for mirrored spheres.
vec2 sphere_uv(vec4 x_axis, vec3 z_axis, vec3 from_centre) {
  vec3 y_axis = x_axis.w * cross(z_axis, x_axis.xyz);
  vec3 q = vec3(dot(from_centre, x_axis.xyz), dot(from_centre, y_axis), dot(from_centre, z_axis));
  float phi = xatan2(q.y, q.x) * kInvTwoPi;
  return vec2(phi < 0.0 ? phi + 1.0 : phi, xatan2(length(q.xy), q.z) * kInvPi);
}

#endif
