// The compressed 8-wide BVH and its leaves, as rows of 16 bytes. Written by host/accel/flatten_bvh8, read by
// geometry/bvh.glsl.
//
// Node: kBvhNodeRows rows of uvec4 (80 bytes), after Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray
// Traversal on GPUs Through Compressed Wide BVHs", with one leaf primitive per leaf slot and sparse children
// (child node = child_base * 8 + slot, so that a stack entry is one word; nodes with disjoint inner masks may share a
// block of 8, which is why sparse children cost only an eighth more memory than dense ones):
//   row 0: p.x, p.y, p.z (float bits: lower corner of the node's box); ex | ey << 8 | ez << 16 | inner_mask << 24,
//          e = biased float exponent of the grid step of each axis
//   row 1: child_base; leaf_base; 0; leaf_mask (8 bits) | kinds << 16 (two bits a slot: kLeaf... of what it holds)
//   row 2: lo_x of slots 0-3, 4-7; lo_y 0-3, 4-7          one byte a slot; box = p + q * 2^(e - 127)
//   row 3: lo_z 0-3, 4-7; hi_x 0-3, 4-7
//   row 4: hi_y 0-3, 4-7; hi_z 0-3, 4-7
// An empty slot has lo = 255, hi = 0 on all axes: it is not hit when near and far are chosen by the sign of the
// direction, but far from a small node both may round to the same t, so hits are masked by inner_mask and leaf_mask.
// Boxes are kBvhBoxMargin grid steps larger than what they hold, against rounding in the ray test.
// The leaf of slot s is leaf_base + popcount(leaf_mask & ((1 << s) - 1)). Slots are octants: bit a of a slot
// is set if the child lies on the positive side of axis a, so that a ray meets inner children from near to far in
// descending order of slot ^ 7 ^ (sign bits of its direction).
// No path from the root has more than kBvhMaxDepth nodes: a stack of kBvhMaxDepth + 1 words never overflows.
//
// Leaf: kBvhLeafRows rows of vec4 (64 bytes, a line of most caches).
//   Triangle pair: one row an axis, of the vertices v0 v1 v2 v3 (so that a kernel permutes axes by what it loads).
//   Triangle 0 is (v0, v1, v2), triangle 1 is (v0, v2, v3); a lone triangle has v3 = v2. Vertices are bit-equal to
//   those of the meshes, so that edges shared between pairs are watertight.
//   Curved: rows of the world-to-object transform (3 x 4); row r = (m_r0, m_r1, m_r2, translation_r).
//   Row 3 is the leaf's info, which kernels read through a view of uvec4: (primitive of triangle 0 or of the curved shape,
//   primitive of triangle 1, kLeaf kind, rotations). A lone triangle or curved shape stands in both primitive words.
//   shared/geometry.h has what the renderer adds.
// A hit names 2 * leaf + triangle.
// Winding is that of the mesh, but a leaf's triangle may begin at another vertex: its vertex k is vertex (k + r) % 3 of
// the mesh's triangle, r = bits 0-1 of the rotations for triangle 0, bits 2-3 for triangle 1. So with the leaf's
// barycentrics (l0, l1, l2) the mesh's (b1, b2) are (l1, l2) for r = 0, (l0, l1) for r = 1, (l2, l0) for r = 2.
#ifndef TACHYLITE_SHARED_BVH_H
#define TACHYLITE_SHARED_BVH_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

TACHYLITE_CONST uint kBvhNodeRows = 5u;
TACHYLITE_CONST uint kBvhLeafRows = 4u;
TACHYLITE_CONST uint kBvhMaxDepth = 31u;
TACHYLITE_CONST float kBvhBoxMargin = 1.0f / 4096.0f;
TACHYLITE_CONST uint kNoHit = 0xffffffffu;

// Kinds of leaves.
TACHYLITE_CONST uint kLeafTriangles = 0u;   // one or two triangles
TACHYLITE_CONST uint kLeafSphere = 1u;      // unit sphere in object space
TACHYLITE_CONST uint kLeafDisk = 2u;        // z = 0, x^2 + y^2 <= 1
TACHYLITE_CONST uint kLeafCylinder = 3u;    // x^2 + y^2 = 1, 0 <= z <= 1

TACHYLITE_SHARED_END
#endif
