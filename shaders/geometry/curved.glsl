// Intersection of a ray with the unit sphere, disk or cylinder of shared/bvh.h.
#ifndef TACHYLITE_GEOMETRY_CURVED_GLSL
#define TACHYLITE_GEOMETRY_CURVED_GLSL
#include "geometry/ray.glsl"

// o, d in object space (d of any length, so that t is that of the world); `wanted` false: no hit.
// Sphere and cylinder: Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection": the discriminant from
// the point nearest to the centre, and the root of smaller size from the product of both.
void hit_curved(vec3 o, vec3 d, uint kind, uint leaf, bool wanted, TraceRay ray, inout TraceHit hit) {
  uint id = 2u * leaf;
  bool leaves = id == ray.ignored;

  float t_plane = -o.z / d.z;
  vec2 p = o.xy + t_plane * d.xy;
  bool on_disk = dot(p, p) <= 1.0 && !leaves;

  // x^2 + y^2 + s z^2 = 1
  float s = kind == kLeafSphere ? 1.0 : 0.0;
  vec3 f = vec3(o.xy, s * o.z), e = vec3(d.xy, s * d.z);
  float a = dot(e, e), b = -dot(f, e), c = dot(f, f) - 1.0;
  vec3 nearest = f + (b / a) * e;
  float discriminant = 1.0 - dot(nearest, nearest);
  float q = b + (b < 0.0 ? -1.0 : 1.0) * sqrt(a * max(discriminant, 0.0));
  float ta = c / q, tb = q / a;
  float near = min(ta, tb), far = max(ta, tb);
  // Of a ray that leaves the shape itself one root is 0 but for rounding: the far one counts, if the ray goes inside.
  near = leaves ? -1.0 : near;
  far = leaves && b <= 0.0 ? -1.0 : far;
  float z_near = o.z + near * d.z, z_far = o.z + far * d.z;
  bool sphere = kind == kLeafSphere;
  bool near_counts = near > 0.0 && (sphere || (z_near >= 0.0 && z_near <= 1.0));
  bool far_counts = far > 0.0 && (sphere || (z_far >= 0.0 && z_far <= 1.0));

  bool disk = kind == kLeafDisk;
  float t = disk ? t_plane : (near_counts ? near : far);
  bool found = disk ? on_disk : discriminant >= 0.0 && (near_counts || far_counts);
  found = found && wanted && t > 0.0 && (t < hit.t || (t == hit.t && id < hit.id)) && id != ray.ignored_target;
  hit.id = found ? id : hit.id;
  hit.t = found ? t : hit.t;
  hit.b1 = found ? 0.0 : hit.b1;
  hit.b2 = found ? 0.0 : hit.b2;
}

#endif
