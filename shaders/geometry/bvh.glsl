// Traversal of the compressed 8-wide BVH, one ray a lane.
#ifndef TACHYLITE_GEOMETRY_BVH_GLSL
#define TACHYLITE_GEOMETRY_BVH_GLSL
#include "base/features.glsl"
#include "geometry/load.glsl"
#include "shared/geometry.h"

struct TraceRay {
  vec3 o, d;
  float tmax;
  uint ignored, ignored_target;  // hits that do not count (kNoHit: none)
};
struct TraceHit {
  uint id;       // 2 * leaf + triangle, kNoHit
  float b1, b2;  // barycentrics in the leaf's order of vertices
  float t;
};

// Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection": a, b, c are vertices relative to the origin,
// sheared so that the ray is the z axis.
void hit_triangle(vec3 a, vec3 b, vec3 c, float scale_z, uint id, TraceRay ray, inout TraceHit hit) {
  precise float u = c.x * b.y - c.y * b.x;
  precise float v = a.x * c.y - a.y * c.x;
  precise float w = b.x * a.y - b.y * a.x;
  float det = u + v + w;
  bool inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
  float inv = 1.0 / det;
  float t = (u * a.z + v * b.z + w * c.z) * scale_z * inv;
  bool found = inside && det != 0.0 && t > 0.0 && (t < hit.t || (t == hit.t && id < hit.id)) && id != ray.ignored &&
               id != ray.ignored_target;
  hit.t = found ? t : hit.t;
  hit.b1 = found ? v * inv : hit.b1;
  hit.b2 = found ? w * inv : hit.b2;
  hit.id = found ? id : hit.id;
}

// A unit sphere, disk or cylinder under the rows of world-to-object.
void hit_curved(vec4 r0, vec4 r1, vec4 r2, uint kind, uint id, TraceRay ray, inout TraceHit hit) {
  vec3 o = vec3(dot(r0.xyz, ray.o) + r0.w, dot(r1.xyz, ray.o) + r1.w, dot(r2.xyz, ray.o) + r2.w);
  vec3 d = vec3(dot(r0.xyz, ray.d), dot(r1.xyz, ray.d), dot(r2.xyz, ray.d));
  float t0, t1;
  bool exists = true;
  if (kind == kLeafDisk) {
    t0 = t1 = -o.z / d.z;
    vec2 p = o.xy + t0 * d.xy;
    exists = dot(p, p) <= 1.0 && id != ray.ignored;
  } else {
    // x^2 + y^2 + s z^2 = 1; Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection".
    float s = kind == kLeafSphere ? 1.0 : 0.0;
    vec3 os = vec3(o.xy, s * o.z), ds = vec3(d.xy, s * d.z);
    float a = dot(ds, ds), b = -dot(os, ds), c = dot(os, os) - 1.0;
    vec3 nearest = os + (b / a) * ds;
    float discriminant = 1.0 - dot(nearest, nearest);
    float q = b + (b < 0.0 ? -1.0 : 1.0) * sqrt(a * max(discriminant, 0.0));
    float ta = c / q, tb = q / a;
    // A ray that leaves the shape itself has a root at 0 but for rounding: the other one counts.
    bool leaves = id == ray.ignored;
    t0 = leaves ? -1.0 : min(ta, tb);
    t1 = leaves ? (b > 0.0 ? max(ta, tb) : -1.0) : max(ta, tb);
    exists = discriminant >= 0.0 && a > 0.0;
    if (kind == kLeafCylinder) {
      float z0 = o.z + t0 * d.z, z1 = o.z + t1 * d.z;
      t0 = z0 >= 0.0 && z0 <= 1.0 ? t0 : -1.0;
      t1 = z1 >= 0.0 && z1 <= 1.0 ? t1 : -1.0;
    }
  }
  float t = t0 > 0.0 ? t0 : t1;
  bool found = exists && t > 0.0 && t < hit.t && id != ray.ignored_target;
  hit.t = found ? t : hit.t;
  hit.id = found ? id : hit.id;
}

vec4 unpack_bytes(uint w) { return vec4(w & 0xffu, (w >> 8u) & 0xffu, (w >> 16u) & 0xffu, w >> 24u); }
uint mask_of(bvec4 b) { return (b.x ? 1u : 0u) | (b.y ? 2u : 0u) | (b.z ? 4u : 0u) | (b.w ? 8u : 0u); }

// Closest hit, or with `any` some hit.
TraceHit trace_ray(TraceRay ray, bool any) {
  TraceHit hit = TraceHit(kNoHit, 0.0, 0.0, ray.tmax);
  vec3 d = mix(ray.d, uintBitsToFloat((floatBitsToUint(ray.d) & 0x80000000u) | floatBitsToUint(1e-18)),
               lessThan(abs(ray.d), vec3(1e-18)));
  vec3 inv = 1.0 / d;
  bvec3 neg = lessThan(d, vec3(0.0));
  uint octant = 7u ^ (uint(neg.x) | uint(neg.y) << 1u | uint(neg.z) << 2u);
  // Axes for the triangle test: z is the largest component of d.
  vec3 ad = abs(ray.d);
  bool along_x = ad.x > ad.y && ad.x > ad.z, along_y = !along_x && ad.y > ad.z;
  vec3 dp = along_x ? ray.d.yzx : (along_y ? ray.d.zxy : ray.d);
  float scale_z = 1.0 / dp.z;
  vec2 shear = dp.xy * scale_z;

  uint stack[kBvhMaxDepth + 1u];
  stack[0] = 0u;
  int top = 1;
  uint group = 1u << octant;  // child_base << 8 | children still to visit
  while ((group & 0xffu) != 0u) {
    uint bit = uint(findMSB(group & 0xffu));
    group &= ~(1u << bit);
    stack[top] = group;
    top += (group & 0xffu) != 0u ? 1 : 0;
    uint row = ((group >> 8u) * 8u + (bit ^ octant)) * kBvhNodeRows;
    uvec4 n0 = load_bvh_node(row), n1 = load_bvh_node(row + 1u), n2 = load_bvh_node(row + 2u);
    uvec4 n3 = load_bvh_node(row + 3u), n4 = load_bvh_node(row + 4u);
    vec3 scale = uintBitsToFloat((uvec3(n0.w, n0.w >> 8u, n0.w >> 16u) & 0xffu) << 23u) * inv;
    vec3 base = (uintBitsToFloat(n0.xyz) - ray.o) * inv;
    uvec2 near_x = neg.x ? n3.zw : n2.xy, far_x = neg.x ? n2.xy : n3.zw;
    uvec2 near_y = neg.y ? n4.xy : n2.zw, far_y = neg.y ? n2.zw : n4.xy;
    uvec2 near_z = neg.z ? n4.zw : n3.xy, far_z = neg.z ? n3.xy : n4.zw;
    // Rounding of (p + q 2^e - o) / d: three operations; the far side is pushed out by it (Ize 2013).
    const float grow = 1.0000008;
    uint mask = 0u;
    for (int half_node = 0; half_node < 2; ++half_node) {
      vec4 tn = max(max(unpack_bytes(near_x[half_node]) * scale.x + base.x, unpack_bytes(near_y[half_node]) * scale.y + base.y),
                    max(unpack_bytes(near_z[half_node]) * scale.z + base.z, vec4(0.0)));
      vec4 tf = min(min(unpack_bytes(far_x[half_node]) * scale.x + base.x, unpack_bytes(far_y[half_node]) * scale.y + base.y),
                    min(unpack_bytes(far_z[half_node]) * scale.z + base.z, vec4(hit.t)));
      mask |= mask_of(lessThanEqual(tn, tf * grow)) << uint(4 * half_node);
    }
    uint inner = mask & (n0.w >> 24u), leaves = mask & n1.w & 0xffu;
    uint t;
    t = ((inner & 0x55u) << 1u) | ((inner >> 1u) & 0x55u);
    inner = (octant & 1u) != 0u ? t : inner;
    t = ((inner & 0x33u) << 2u) | ((inner >> 2u) & 0x33u);
    inner = (octant & 2u) != 0u ? t : inner;
    t = ((inner & 0x0fu) << 4u) | (inner >> 4u);
    inner = (octant & 4u) != 0u ? t : inner;

    while (leaves != 0u) {
      uint slot = uint(findLSB(leaves));
      leaves &= leaves - 1u;
      uint leaf = n1.y + uint(bitCount(n1.w & 0xffu & ((1u << slot) - 1u)));
      vec4 r0 = load_bvh_leaf(leaf * kBvhLeafRows), r1 = load_bvh_leaf(leaf * kBvhLeafRows + 1u);
      vec4 r2 = load_bvh_leaf(leaf * kBvhLeafRows + 2u);
      bool is_curved = has_curved && ((n1.z >> slot) & 1u) != 0u;
      if (has_triangles && !is_curved) {
        vec3 v0 = r0.xyz - ray.o, v1 = vec3(r0.w, r1.xy) - ray.o, v2 = vec3(r1.zw, r2.x) - ray.o, v3 = r2.yzw - ray.o;
        v0 = along_x ? v0.yzx : (along_y ? v0.zxy : v0);
        v1 = along_x ? v1.yzx : (along_y ? v1.zxy : v1);
        v2 = along_x ? v2.yzx : (along_y ? v2.zxy : v2);
        v3 = along_x ? v3.yzx : (along_y ? v3.zxy : v3);
        v0.xy -= shear * v0.z;
        v1.xy -= shear * v1.z;
        v2.xy -= shear * v2.z;
        v3.xy -= shear * v3.z;
        hit_triangle(v0, v1, v2, scale_z, 2u * leaf, ray, hit);
        hit_triangle(v0, v2, v3, scale_z, 2u * leaf + 1u, ray, hit);
      }
      if (is_curved) {
        uint kind = texelFetch(leaf_info, int(leaf)).z & kLeafKindMask;
        hit_curved(r0, r1, r2, kind, 2u * leaf, ray, hit);
      }
    }
    bool finished = any && hit.id != kNoHit;
    bool none = inner == 0u;
    top -= none ? 1 : 0;
    group = none ? stack[top] : (n1.x << 8u | inner);
    group = finished ? 0u : group;
  }
  return hit;
}

#endif
