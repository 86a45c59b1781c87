// Traversal of the compressed 8-wide BVH of shared/bvh.h, one ray a lane.
//
// One loop: a step visits one node and tests one leaf, of a node visited before. What the two need is loaded at the
// top of the step, so that the memory's latency is waited for once (lavapipe loads for all lanes of a subgroup one
// after the other, and a scene's tree does not fit into a cache); and no lane waits for another's many leaves.
// Only one node's leaves wait to be tested: a lane does not go on to another node before the last of them.
#ifndef TACHYLITE_GEOMETRY_BVH_GLSL
#define TACHYLITE_GEOMETRY_BVH_GLSL
#include "base/features.glsl"
#include "geometry/curved.glsl"
#include "geometry/load.glsl"
#include "geometry/triangle.glsl"

struct Traversal {
  TraceRay ray;
  TriangleRay triangle_ray;
  TraceHit hit;
  vec3 inverse, inverse_far;  // 1 / d; and a little larger, see visit_node
  bvec3 negative;             // signs of d
  uint octant;                // 7 ^ sign bits
  uint group;                 // child_base << 8 | children to visit; bit = slot ^ octant, from near to far downwards
  int top;                    // of trace_stack
  uint leaf_base;
  uint leaves;                // leaf_mask | leaves to test << 8 | kinds << 16, as in row 1 of their node
};

// Groups of siblings that wait. Entry 1 is 0, which ends the traversal; entry 0 is only what lanes that have ended read.
uint trace_stack[kBvhMaxDepth + 2u];

const uint kPendingLeaves = 0xff00u;

Traversal begin_traversal(TraceRay ray) {
  Traversal s;
  s.ray = ray;
  s.triangle_ray = make_triangle_ray(ray.o, ray.d);
  s.hit = TraceHit(kNoHit, 0.0, 0.0, ray.tmax);
  // No 0 * infinity in the slab test; coordinates are at most 1e18.
  vec3 d = mix(ray.d, uintBitsToFloat((floatBitsToUint(ray.d) & 0x80000000u) | floatBitsToUint(1e-18)),
               lessThan(abs(ray.d), vec3(1e-18)));
  s.inverse = 1.0 / d;
  s.inverse_far = s.inverse * 1.0000007;
  s.negative = lessThan(d, vec3(0.0));
  s.octant = 7u ^ (uint(s.negative.x) | uint(s.negative.y) << 1u | uint(s.negative.z) << 2u);
  s.group = 1u << s.octant;
  s.top = 2;
  s.leaf_base = 0u;
  s.leaves = 0u;
  trace_stack[1] = 0u;
  return s;
}

// Bit s of the mask goes to bit s ^ octant.
uint permute_mask(uint mask, uint octant) {
  uint t = ((mask & 0x55u) << 1u) | ((mask >> 1u) & 0x55u);
  mask = (octant & 1u) != 0u ? t : mask;
  t = ((mask & 0x33u) << 2u) | ((mask >> 2u) & 0x33u);
  mask = (octant & 2u) != 0u ? t : mask;
  t = ((mask & 0x0fu) << 4u) | (mask >> 4u);
  return (octant & 4u) != 0u ? t : mask;
}

// What the first step would do of a traversal that has just begun; slots: of the root, those whose boxes the ray meets.
void visit_root(inout Traversal s, uint slots) {
  uvec4 n0 = load_bvh_node(0u), n1 = load_bvh_node(1u);
  uint inner = permute_mask(slots & (n0.w >> 24u), s.octant);
  s.group = n1.x << 8u | inner;
  s.leaf_base = n1.y;
  s.leaves = n1.w | (slots & n1.w & 0xffu) << 8u;
}

bool is_traversing(Traversal s) { return (s.group & 0xffu) != 0u || (s.leaves & kPendingLeaves) != 0u; }

// 1 + q / 256 for each of four bytes q: the byte becomes mantissa bits. Cheaper than a conversion.
vec4 unpack_bytes(uint w) {
  return uintBitsToFloat((uvec4(w << 15u, w << 7u, w >> 1u, w >> 9u) & 0x007f8000u) | 0x3f800000u);
}

// min and max without a rule for NaN, which costs two more instructions.
vec4 least(vec4 a, vec4 b) { return mix(b, a, lessThan(a, b)); }
vec4 greatest(vec4 a, vec4 b) { return mix(b, a, greaterThan(a, b)); }

uint mask_of(bvec4 b) { return (b.x ? 1u : 0u) | (b.y ? 2u : 0u) | (b.z ? 4u : 0u) | (b.w ? 8u : 0u); }

// The slots whose boxes the ray meets.
//
// t = (1 + q / 256) S + O with S = 256 * step / d and O = (p - o) / d - S. With u = 2^-24, rounding changes t by at
// most 5 u |t| + 1533 u step / |d|. The builder keeps boxes 2^-12 steps larger than what they hold, which covers the
// second term; the first one is covered by 12 u on the far side (Ize 2013, "Robust BVH Ray Traversal").
uint hit_boxes(Traversal s, uvec4 n0, uvec4 n2, uvec4 n3, uvec4 n4) {
  vec3 step = uintBitsToFloat(uvec3(n0.w << 23u, n0.w << 15u, n0.w << 7u) & 0x7f800000u) * 256.0;
  vec3 to_node = uintBitsToFloat(n0.xyz) - s.ray.o;
  vec3 scale = step * s.inverse, scale_far = step * s.inverse_far;
  vec3 offset = to_node * s.inverse - scale, offset_far = to_node * s.inverse_far - scale_far;
  uvec2 near_x = s.negative.x ? n3.zw : n2.xy, far_x = s.negative.x ? n2.xy : n3.zw;
  uvec2 near_y = s.negative.y ? n4.xy : n2.zw, far_y = s.negative.y ? n2.zw : n4.xy;
  uvec2 near_z = s.negative.z ? n4.zw : n3.xy, far_z = s.negative.z ? n3.xy : n4.zw;
  vec4 far = vec4(s.hit.t * 1.0000007);
  vec4 enter0 = greatest(greatest(unpack_bytes(near_x.x) * scale.x + offset.x, unpack_bytes(near_y.x) * scale.y + offset.y),
                         greatest(unpack_bytes(near_z.x) * scale.z + offset.z, vec4(0.0)));
  vec4 enter1 = greatest(greatest(unpack_bytes(near_x.y) * scale.x + offset.x, unpack_bytes(near_y.y) * scale.y + offset.y),
                         greatest(unpack_bytes(near_z.y) * scale.z + offset.z, vec4(0.0)));
  vec4 leave0 = least(least(unpack_bytes(far_x.x) * scale_far.x + offset_far.x, unpack_bytes(far_y.x) * scale_far.y + offset_far.y),
                      least(unpack_bytes(far_z.x) * scale_far.z + offset_far.z, far));
  vec4 leave1 = least(least(unpack_bytes(far_x.y) * scale_far.x + offset_far.x, unpack_bytes(far_y.y) * scale_far.y + offset_far.y),
                      least(unpack_bytes(far_z.y) * scale_far.z + offset_far.z, far));
  return mask_of(lessThanEqual(enter0, leave0)) | mask_of(lessThanEqual(enter1, leave1)) << 4u;
}

// One step of a traversal; does nothing to one that has ended. With `any` the first hit ends it.
void step_traversal(inout Traversal s, const bool any) {
  uint pending = s.leaves & kPendingLeaves;
  bool test_leaf = pending != 0u;
  bool visit_node = (s.group & 0xffu) != 0u && (pending & (pending - 1u)) == 0u;

  uint leaf_slot = uint(findLSB(pending | 0x8000u)) - 8u;
  uint leaf = test_leaf ? s.leaf_base + uint(bitCount(s.leaves & ((1u << leaf_slot) - 1u))) : 0u;
  uint leaf_kind = (s.leaves >> (16u + 2u * leaf_slot)) & 3u;
  uint bit = uint(findMSB((s.group & 0xffu) | 1u));
  uint row = visit_node ? ((s.group >> 8u) * 8u + (bit ^ s.octant)) * kBvhNodeRows : 0u;

  uvec4 n0 = load_bvh_node(row);
  uint leaf_row = leaf * kBvhLeafRows;
  vec4 lz = load_bvh_leaf(leaf_row + uint(s.triangle_ray.axes.z));
  uvec4 n1 = load_bvh_node(row + 1u), n2 = load_bvh_node(row + 2u);
  uvec4 n3 = load_bvh_node(row + 3u), n4 = load_bvh_node(row + 4u);
  vec4 lx = load_bvh_leaf(leaf_row + uint(s.triangle_ray.axes.x));
  vec4 ly = load_bvh_leaf(leaf_row + uint(s.triangle_ray.axes.y));

  // Push what is left of the group, then take the node's inner children, or pop.
  uint mask = hit_boxes(s, n0, n2, n3, n4);
  uint inner = permute_mask(mask & (n0.w >> 24u), s.octant);
  uint rest = s.group & ~(1u << bit);
  trace_stack[s.top] = rest;
  int top = s.top + ((rest & 0xffu) != 0u ? 1 : 0) - (inner == 0u ? 1 : 0);
  uint popped = trace_stack[top];
  s.group = visit_node ? (inner == 0u ? popped : (n1.x << 8u | inner)) : s.group;
  s.top = visit_node ? top : s.top;
  s.leaf_base = visit_node ? n1.y : s.leaf_base;
  s.leaves = visit_node ? n1.w | (mask & n1.w & 0xffu) << 8u : s.leaves & ~(pending & -pending);

  if (has_triangles) {
    bool wanted = test_leaf && (!has_curved || leaf_kind == kLeafTriangles);
    hit_triangles(lx, ly, lz, s.triangle_ray, leaf, wanted, s.ray, s.hit);
  }
  if (has_curved) {
    vec4 o = vec4(s.ray.o, 1.0);
    vec3 oo = vec3(dot(lx, o), dot(ly, o), dot(lz, o));
    vec3 od = vec3(dot(lx.xyz, s.ray.d), dot(ly.xyz, s.ray.d), dot(lz.xyz, s.ray.d));
    int z = s.triangle_ray.axes.z;  // undo the permutation of the rows
    oo = z == 0 ? oo.zxy : (z == 1 ? oo.yzx : oo);
    od = z == 0 ? od.zxy : (z == 1 ? od.yzx : od);
    hit_curved(oo, od, leaf_kind, leaf, test_leaf && leaf_kind != kLeafTriangles, s.ray, s.hit);
  }
  if (any) {
    bool found = s.hit.id != kNoHit;
    s.group = found ? 0u : s.group;
    s.leaves = found ? 0u : s.leaves;
  }
}

// Whether a loop of this lane ended before its rays did: Mesa 22.3.6 ends all loops of an invocation after 65535
// iterations. The kernel reports it (base/queues.glsl).
bool rays_unfinished = false;

// Closest hit, or with `any` some hit, of one ray a lane.
TraceHit trace_ray(TraceRay ray, const bool any) {
  Traversal s = begin_traversal(ray);
  do step_traversal(s, any);
  while (is_traversing(s));
  rays_unfinished = rays_unfinished || is_traversing(s);
  return s.hit;
}

#endif
