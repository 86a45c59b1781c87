// Orthonormal right-handed frames (s, t, n).
#ifndef TACHYLITE_BASE_FRAME_GLSL
#define TACHYLITE_BASE_FRAME_GLSL

struct Frame {
  vec3 s, t, n;
};

/// Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3; for a unit n. Continuous except at n.z = 0.
Frame frame_from_normal(vec3 n) {
  const float side = n.z < 0.0 ? -1.0 : 1.0;
  const float a = -1.0 / (side + n.z);
  const float b = n.x * n.y * a;
  return Frame(vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x), vec3(b, side + n.y * n.y * a, -n.y), n);
}

/// The frame about the unit n whose s is nearest to the given tangent (Gram and Schmidt); any frame about n where the
/// tangent is (nearly) parallel to n or zero.
Frame frame_from_normal_tangent(vec3 n, vec3 tangent) {
  const vec3 s = tangent - n * dot(n, tangent);
  const float length2 = dot(s, s);
  if (!(length2 > 1e-12 * dot(tangent, tangent))) return frame_from_normal(n);
  const vec3 unit = s * inversesqrt(length2);
  return Frame(unit, cross(n, unit), n);
}

/// World to local: (v.s, v.t, v.n); local z is along n.
vec3 to_local(Frame f, vec3 v) { return vec3(dot(v, f.s), dot(v, f.t), dot(v, f.n)); }
vec3 to_world(Frame f, vec3 v) { return f.s * v.x + f.t * v.y + f.n * v.z; }

#endif
