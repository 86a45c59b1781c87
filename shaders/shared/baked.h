// Geometry of tiny scenes as specialization constants: every primitive is tested by straight-line code, without a
// tree. Written by host/pack/bake_geometry, read by geometry/baked.glsl.
//
// Primitive i has kBakedConstants constants from id kBakedFirstConstant + i * kBakedConstants on:
//   0: kind kBaked..., flags; from bit kBakedRowShift on the primitive's first pair of rows below
//   parallelogram, triangle: 1..4: N, wN; 5..8: A, wA; 9..12: B, wB; 13: h; 14: k
//     A point p of the plane dot(N, p) + wN = 0 has s = dot(A, p) + wA and t = dot(B, p) + wB and lies in the
//     parallelogram where |s| <= |h| and |t| <= |k|; in the triangle if also s / h + t / k <= 0. N, A, B are unit; one
//     direction is always written with the same bits and sign, so that the compiler shares the dot products of
//     parallel faces. h and k are a little (1e-6) too large: faces that meet leave no gap.
//   sphere: 1..3: centre; 4: radius
//   these: 15: the hit that names it: 2 * leaf + triangle (2 * leaf for a parallelogram or sphere)
//   box, a parallelepiped of four to six faces that are no lights: 1..3: N0, 5..7: N1, 9..11: N2; the planes
//     dot(Nk, p) = w: 4, 8, 12 for face 2 k, with the smaller w, and 13, 14, 15 for face 2 k + 1. The faces that are
//     there: 1 << face, from bit kBakedFaceShift of constant 0. Its hits are named by its faces' rows.
// Walls are parallelograms that a larger scene's tree leaves out (accel/choose_walls.h), as such constants of the trace
// kernels, at most kMaxWalls primitives. Of each face kWallRows rows of vec4 in kBindBaked, in the order of rows below:
//   rows 0, 1: dual vectors and offsets: a point v0 + a (v1 - v0) + b (v3 - v0) of the leaf has a = dot(row0, (p, 1)), b
//     = dot(row1, (p, 1)); row 2: bits of the hit 2 * leaf.
// What shading of tiny scenes needs of primitive i, or of each of the six faces of a box, kBakedRows rows of vec4 in kBindBaked:
//   row 0: outward unit normal, offset: dot(n, p) + w = 0 (sphere: centre, radius; negative: normals point inwards)
//   row 1: bits of: material row (kNoIndex: absorbs everything); light row; primitive of the scene (curved: kNoIndex); hit
#ifndef TACHYLITE_SHARED_BAKED_H
#define TACHYLITE_SHARED_BAKED_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

TACHYLITE_CONST uint kBakedNone = 0u;
TACHYLITE_CONST uint kBakedParallelogram = 1u;
TACHYLITE_CONST uint kBakedTriangle = 2u;
TACHYLITE_CONST uint kBakedSphere = 3u;
TACHYLITE_CONST uint kBakedBox = 4u;
TACHYLITE_CONST uint kBakedKindMask = 7u;
TACHYLITE_CONST uint kBakedEmits = 8u;  // a light that shadow rays may aim at
TACHYLITE_CONST uint kBakedHull = 16u;  // everything lies on one side of each of its planes: in no shadow ray's way
TACHYLITE_CONST uint kBakedFaceShift = 8u;
TACHYLITE_CONST uint kBakedRowShift = 16u;

TACHYLITE_CONST uint kBakedFirstConstant = 64u;
TACHYLITE_CONST uint kBakedConstants = 16u;
TACHYLITE_CONST uint kBakedRows = 2u;
TACHYLITE_CONST uint kWallRows = 3u;
TACHYLITE_CONST uint kMaxBaked = 64u;
TACHYLITE_CONST uint kMaxWalls = 8u;

TACHYLITE_SHARED_END
#endif
