// Watertight intersection of a ray with the two triangles of a leaf: Woop, Benthin and Wald 2013, "Watertight
// Ray/Triangle Intersection". Vertices are translated to the ray's origin and sheared so that the ray becomes the z
// axis, each vertex alone, so that two triangles that share a vertex see it at the same place. The edge functions are
// then exact in sign or zero, and zero counts as inside: a ray cannot pass between neighbours.
// The paper permutes the axes of each vertex; here a leaf holds one row an axis, and the rows are loaded permuted.
#ifndef TACHYLITE_GEOMETRY_TRIANGLE_GLSL
#define TACHYLITE_GEOMETRY_TRIANGLE_GLSL
#include "geometry/ray.glsl"

// The axes (x, y, z) such that z is the largest component of d, in cyclic order, as numbers of leaf rows.
struct TriangleRay {
  ivec3 axes;
  vec3 o;      // origin, permuted
  vec3 shear;  // (d.x, d.y, 1) / d.z, permuted
};

TriangleRay make_triangle_ray(vec3 o, vec3 d) {
  vec3 a = abs(d);
  bool along_x = a.x > a.y && a.x > a.z, along_y = !along_x && a.y > a.z;
  vec3 e = along_x ? d.yzx : (along_y ? d.zxy : d);
  float inverse = 1.0 / e.z;
  return TriangleRay(along_x ? ivec3(1, 2, 0) : (along_y ? ivec3(2, 0, 1) : ivec3(0, 1, 2)),
                     along_x ? o.yzx : (along_y ? o.zxy : o), vec3(e.xy * inverse, inverse));
}

// Of two hits at equal t the one with the lower id counts, so that the order of tests does not matter.
void take_hit(bool found, uint id, float t, float b1, float b2, TraceRay ray, inout TraceHit hit) {
  found = found && t > 0.0 && (t < hit.t || (t == hit.t && id < hit.id)) && id != ray.ignored &&
          id != ray.ignored_target;
  hit.id = found ? id : hit.id;
  hit.t = found ? t : hit.t;
  hit.b1 = found ? b1 : hit.b1;
  hit.b2 = found ? b2 : hit.b2;
}

// a, moved to the range of lo <= hi and x; also where a is not a number.
float between(float a, float lo, float x, float hi) {
  lo = x < lo ? x : lo;
  hi = x > hi ? x : hi;
  a = a > lo ? a : lo;
  return a < hi ? a : hi;
}

// rows x, y, z of the leaf's four vertices, permuted; `wanted` false: no hit.
// t is that of the triangle's plane, moved to the range of the vertices (edge-on, rounding makes the plane any). The
// paper interpolates it between vertices: near a large triangle, above all one that is parallel to an axis, that is much
// less accurate. The normal of two edges a and b is off by 2^-24 |a| |b| / (2 area): not the shared edge 02, which is
// the longest one of most pairs, and of triangles alone.
void hit_triangles(vec4 x, vec4 y, vec4 z, TriangleRay r, uint leaf, bool wanted, TraceRay ray, inout TraceHit hit) {
  vec4 ex = x.yzwx - x, ey = y.yzwx - y, ez = z.yzwx - z;  // 01 12 23 30
  x -= r.o.x;
  y -= r.o.y;
  z -= r.o.z;
  precise vec4 px = x - r.shear.x * z, py = y - r.shear.y * z;
  // e_ij is antisymmetric in i and j, bit for bit.
  precise float e12 = px.y * py.z - py.y * px.z, e20 = px.z * py.x - py.z * px.x, e01 = px.x * py.y - py.x * px.y;
  precise float e23 = px.z * py.w - py.z * px.w, e30 = px.w * py.x - py.w * px.x, e02 = -e20;
  float det0 = e12 + e20 + e01, det1 = e23 + e30 + e02;
  bool inside0 = min(min(e12, e20), e01) >= 0.0 || max(max(e12, e20), e01) <= 0.0;
  bool inside1 = min(min(e23, e30), e02) >= 0.0 || max(max(e23, e30), e02) <= 0.0;
  float inv0 = 1.0 / det0, inv1 = 1.0 / det1;
  vec3 v0 = vec3(x.x, y.x, z.x), d = vec3(r.shear.xy, 1.0);
  vec3 n0 = cross(vec3(ex.x, ey.x, ez.x), vec3(ex.y, ey.y, ez.y));
  vec3 n1 = cross(vec3(ex.z, ey.z, ez.z), vec3(ex.w, ey.w, ez.w));
  float lo = z.x < z.z ? z.x : z.z, hi = z.x < z.z ? z.z : z.x;
  float t0 = between(dot(n0, v0) / dot(n0, d), lo, z.y, hi) * r.shear.z;
  float t1 = between(dot(n1, v0) / dot(n1, d), lo, z.w, hi) * r.shear.z;
  take_hit(wanted && inside0 && det0 != 0.0, 2u * leaf, t0, e20 * inv0, e01 * inv0, ray, hit);
  take_hit(wanted && inside1 && det1 != 0.0, 2u * leaf + 1u, t1, e30 * inv1, e02 * inv1, ray, hit);
}

#endif
