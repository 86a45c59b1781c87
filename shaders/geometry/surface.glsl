// From a hit to an Interaction: position with its error bound, normals, uv, tangents. Conventions are Mitsuba's
// (uv and dp_du of each shape). Needs base/math.glsl for atan2 and acos.
#ifndef TACHYLITE_GEOMETRY_SURFACE_GLSL
#define TACHYLITE_GEOMETRY_SURFACE_GLSL
#include "base/features.glsl"
#include "base/frame.glsl"
#include "base/math.glsl"
#include "geometry/interaction.glsl"
#include "geometry/load.glsl"
#include "shared/bindings.h"
#include "shared/bvh.h"
#include "shared/geometry.h"

layout(set = 0, binding = kBindTriangles) uniform usamplerBuffer triangles;
layout(set = 0, binding = kBindNormals) uniform samplerBuffer normals;
layout(set = 0, binding = kBindUvs) uniform samplerBuffer uvs;
layout(set = 0, binding = kBindCurved) uniform samplerBuffer curved;
layout(set = 0, binding = kBindShapes) uniform usamplerBuffer shapes;

uint leaf_shape(uvec4 info) { return info.w >> kLeafShapeShift; }
uvec4 load_triangle(uint triangle) { return texelFetch(triangles, int(triangle)); }
vec3 load_normal(uint vertex) { return texelFetch(normals, int(vertex)).xyz; }
vec2 load_uv(uint vertex) { return texelFetch(uvs, int(vertex)).xy; }
vec4 load_curved(uint row) { return texelFetch(curved, int(row)); }
uvec4 load_shape(uint row) { return texelFetch(shapes, int(row)); }

// Bounds of the error of p relative to its terms, in units of float rounding (gamma_n = n eps / (1 - n eps) for n
// operations in sequence, Higham 2002), and two more for the additions of offset_origin: 7 for barycentrics; of a
// curved shape p comes from the object-space point by a 3 x 4 transform, and that point from a square root.
const float kGammaTriangle = 9.0 * 5.9604645e-8;
// Of a wall: geometry/baked.glsl sees its plane from there, which is not quite the triangle's.
const float kGammaWall = 24.0 * 5.9604645e-8;
const float kGammaCurved = 18.0 * 5.9604645e-8;

// s and t from dp_du where the material needs them so; else any.
void set_shading_frame(inout Interaction it) {
  Frame frame = has_material(kMaterialTangent) ? frame_from_normal_tangent(it.n_s, it.dp_du) : frame_from_normal(it.n_s);
  it.s = frame.s;
  it.t = frame.t;
}

// A leaf's vertex k is vertex (k + rotation) mod 3 of the mesh's triangle. Barycentrics of that one's vertices 1 and 2:
vec2 mesh_barycentrics(vec3 b, uint rotation) { return rotation == 0u ? b.yz : (rotation == 1u ? b.xy : b.zx); }
// The vertices of the mesh's triangle in the leaf's order:
uvec3 leaf_order(uvec3 v, uint rotation) { return rotation == 0u ? v : (rotation == 1u ? v.yzx : v.zxy); }

// Unit normal of edges of any length: they are scaled before the product, which could underflow. That of the two
// shorter edges: a sliver's others are all but parallel.
vec3 triangle_normal(vec3 e1, vec3 e2, vec3 e12) {
  vec3 a = max(abs(e1), abs(e2));
  float scale = 1.0 / max(max(a.x, a.y), max(a.z, 1e-37));
  e1 *= scale;
  e2 *= scale;
  e12 *= scale;
  float l1 = dot(e1, e1), l2 = dot(e2, e2), l12 = dot(e12, e12);
  return normalize(cross(l1 > max(l2, l12) ? e2 : e1, l12 > max(l1, l2) ? e2 : e12));
}

// id: of the hit, info: of its leaf, b: barycentrics of vertices 1 and 2 in the leaf's order. Vertices come from the leaf,
// which lies in one place; those of the mesh are looked up for normals and uv only.
Interaction triangle_interaction(uint id, uvec4 info, vec2 b) {
  Interaction it;
  it.shape = leaf_shape(info);
  uvec4 shape = load_shape(it.shape);
  it.material = shape.x;
  it.light = shape.y;
  bool flip = (shape.z & kShapeFlipNormals) != 0u;

  uint row = (id >> 1u) * kBvhLeafRows;
  vec4 x = load_bvh_leaf(row), y = load_bvh_leaf(row + 1u), z = load_bvh_leaf(row + 2u);
  bool second = (id & 1u) != 0u;
  vec3 v0 = vec3(x.x, y.x, z.x), middle = vec3(x.z, y.z, z.z);
  vec3 v1 = second ? middle : vec3(x.y, y.y, z.y), v2 = second ? vec3(x.w, y.w, z.w) : middle;
  float b0 = 1.0 - b.x - b.y;
  it.p = b0 * v0 + b.x * v1 + b.y * v2;
  vec3 terms = abs(b0 * v0) + abs(b.x * v1) + abs(b.y * v2);
  bool is_wall = has_walls && (info.z & kLeafWall) != 0u;
  it.p_error = is_wall ? vec3(kGammaWall * (terms.x + terms.y + terms.z)) : kGammaTriangle * terms;
  vec3 e1 = v1 - v0, e2 = v2 - v0;
  vec3 n = triangle_normal(e1, e2, v2 - v1);
  it.n_g = flip ? -n : n;
  it.n_s = it.n_g;
  uint rotation = (info.w >> (second ? 2u : 0u)) & 3u;
  it.point.primitive = second ? info.y : info.x;
  it.point.barycentrics = mesh_barycentrics(vec3(b0, b), rotation);
  it.point.uv = it.point.barycentrics;
  it.dp_du = vec3(0.0);
  it.dp_dv = vec3(0.0);

  uvec3 v = uvec3(0u);
  if (has_vertex_normals || has_vertex_uv) v = leaf_order(load_triangle(it.point.primitive).xyz, rotation);
  if (has_vertex_normals && (shape.z & kShapeHasNormals) != 0u) {
    vec3 ns = b0 * load_normal(v.x) + b.x * load_normal(v.y) + b.y * load_normal(v.z);
    float length2 = dot(ns, ns);
    if (length2 > 1e-12) it.n_s = (flip ? -ns : ns) * inversesqrt(length2);
  }
  if (has_vertex_uv && (shape.z & kShapeHasUv) != 0u) {
    vec2 uv0 = load_uv(v.x), uv1 = load_uv(v.y), uv2 = load_uv(v.z);
    it.point.uv = b0 * uv0 + b.x * uv1 + b.y * uv2;
    vec2 d1 = uv1 - uv0, d2 = uv2 - uv0;
    float det = d1.x * d2.y - d1.y * d2.x;
    if (det != 0.0) {
      it.dp_du = (d2.y * e1 - d1.y * e2) / det;
      it.dp_dv = (d1.x * e2 - d2.x * e1) / det;
    }
  }
  if (has_material(kMaterialTangent) && it.dp_du == vec3(0.0)) {
    Frame frame = frame_from_normal(n);
    it.dp_du = frame.s;
    it.dp_dv = frame.t;
  }
  set_shading_frame(it);
  return it;
}

// info: of the leaf, whose rows transform from world to object; o, d: the ray in device space; t: where it hit.
Interaction curved_interaction(uint leaf, uvec4 info, vec3 o, vec3 d, float t) {
  Interaction it;
  uint kind = info.z & kLeafKindMask, row = leaf * kBvhLeafRows;
  vec4 w0 = load_bvh_leaf(row), w1 = load_bvh_leaf(row + 1u), w2 = load_bvh_leaf(row + 2u);
  vec4 m0 = load_curved(info.x), m1 = load_curved(info.x + 1u), m2 = load_curved(info.x + 2u);
  it.shape = leaf_shape(info);
  uvec4 shape = load_shape(it.shape);
  it.material = shape.x;
  it.light = shape.y;
  bool flip = (shape.z & kShapeFlipNormals) != 0u;

  vec3 hit = o + t * d;
  vec3 q = vec3(dot(w0.xyz, hit) + w0.w, dot(w1.xyz, hit) + w1.w, dot(w2.xyz, hit) + w2.w);
  vec3 n, du, dv;  // in object space
  vec2 uv;
  const float two_pi = 6.28318530718;
  if (kind == kLeafSphere) {
    q = normalize(q);
    float phi = has_vertex_uv ? xatan2(q.y, q.x) : 0.0;
    uv = vec2((phi < 0.0 ? phi + two_pi : phi) / two_pi, has_vertex_uv ? xacos(q.z) / 3.14159265359 : 0.0);
    float r = sqrt(q.x * q.x + q.y * q.y);
    n = q;
    du = vec3(-q.y, q.x, 0.0) * two_pi;
    dv = (r > 0.0 ? vec3(q.z * q.x / r, q.z * q.y / r, -r) : vec3(q.z, 0.0, 0.0)) * 3.14159265359;
  } else if (kind == kLeafDisk) {
    q.z = 0.0;
    float r = length(q.xy);
    float phi = has_vertex_uv ? xatan2(q.y, q.x) : 0.0;
    uv = vec2(r, (phi < 0.0 ? phi + two_pi : phi) / two_pi);
    n = vec3(0.0, 0.0, 1.0);
    vec2 radial = r > 0.0 ? q.xy / r : vec2(1.0, 0.0);
    du = vec3(radial, 0.0);
    dv = vec3(-radial.y, radial.x, 0.0);  // of unit length, as Mitsuba has it
  } else {
    q.xy *= inversesqrt(max(dot(q.xy, q.xy), 1e-30));
    float phi = has_vertex_uv ? xatan2(q.y, q.x) : 0.0;
    uv = vec2((phi < 0.0 ? phi + two_pi : phi) / two_pi, q.z);
    n = vec3(q.xy, 0.0);
    du = vec3(-q.y, q.x, 0.0) * two_pi;
    dv = vec3(0.0, 0.0, 1.0);
  }
  it.p = vec3(dot(m0.xyz, q) + m0.w, dot(m1.xyz, q) + m1.w, dot(m2.xyz, q) + m2.w);
  it.p_error = kGammaCurved * (vec3(dot(abs(m0.xyz), abs(q)), dot(abs(m1.xyz), abs(q)), dot(abs(m2.xyz), abs(q))) +
                               abs(vec3(m0.w, m1.w, m2.w)));
  // Normals go by the inverse transpose: the columns of world-to-object are its rows.
  n = normalize(w0.xyz * n.x + w1.xyz * n.y + w2.xyz * n.z);
  it.n_g = flip ? -n : n;
  it.n_s = it.n_g;
  it.dp_du = vec3(dot(m0.xyz, du), dot(m1.xyz, du), dot(m2.xyz, du));
  it.dp_dv = vec3(dot(m0.xyz, dv), dot(m1.xyz, dv), dot(m2.xyz, dv));
  it.point.uv = uv;
  it.point.primitive = kNoIndex;
  it.point.barycentrics = vec2(0.0);
  set_shading_frame(it);
  return it;
}

// hit = (bits of 2 * leaf + triangle, b1, b2, t) of a ray o + t d that hit something.
Interaction load_interaction(vec4 hit, vec3 o, vec3 d) {
  uint id = floatBitsToUint(hit.x);
  uvec4 info = load_leaf_info(id >> 1u);
  if (has_curved && (info.z & kLeafKindMask) != kLeafTriangles) return curved_interaction(id >> 1u, info, o, d, hit.w);
  return triangle_interaction(id, info, hit.yz);
}

// Moves the origin of a ray that leaves `it` in direction w off the surface, to the side of w, by the bound of the
// error of it.p (Pharr, Jakob and Humphreys, PBRT 4th ed., section 6.8.6): no scene epsilon. Where w stays on the side
// of wo it also goes back towards wo by as much: close to a concave edge p may have been rounded behind the other
// face, but the ray that came from there was in front of both.
vec3 offset_origin(Interaction it, vec3 wo, vec3 w) {
  float distance = dot(abs(it.n_g), it.p_error);
  bool front = dot(w, it.n_g) >= 0.0;
  vec3 offset = front ? distance * it.n_g : -distance * it.n_g;
  if ((dot(wo, it.n_g) >= 0.0) == front) offset += distance * wo;
  return it.p + offset;
}

#endif
