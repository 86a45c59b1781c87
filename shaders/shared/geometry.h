// Records of shapes and primitives. All positions are in device space: world space translated by the scene's centre
// (in double, on the host), so that float resolution lies where the scene is.
//
// Info of a leaf (row 3 of shared/bvh.h, through kBindLeafInfo): (primitive 0, primitive 1,
//   kind | class << 8 | kLeafEmits | kLeafHides | kLeafWall, rotations | shape << 4).
//   kind, rotations: shared/bvh.h; class: queue of the material; shape: its first row in kBindShapes.
//   Of curved leaves primitive 0 is the first row in kBindCurved.
// Triangle (kBindTriangles), one row, where vertices have normals or uv: (vertex 0, vertex 1, vertex 2, unused).
// Curved primitive (kBindCurved), kCurvedRows rows of vec4: object-to-world rows 0..2 (3 x 4).
// Shape (kBindShapes), kShapeRows rows of uvec4:
//   row 0: material (first row in kBindMaterials); light (first row in kBindLights, kNoIndex when none); flags;
//          medium pair: interior | exterior << 16 (0xffff: none)
//   row 1: first primitive; number of primitives; attribute row of the mesh; triangles that count as one primitive
//          outside: 2 of rectangles, else 1
#ifndef TACHYLITE_SHARED_GEOMETRY_H
#define TACHYLITE_SHARED_GEOMETRY_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

TACHYLITE_CONST uint kNoIndex = 0xffffffffu;
TACHYLITE_CONST uint kCurvedRows = 3u;
TACHYLITE_CONST uint kShapeRows = 2u;

// Flags of a shape.
TACHYLITE_CONST uint kShapeFlipNormals = 1u;   // the geometric normal points the other way
TACHYLITE_CONST uint kShapeHasUv = 2u;         // vertex uvs are given; else uv = barycentrics
TACHYLITE_CONST uint kShapeHasNormals = 4u;    // vertex normals are given
TACHYLITE_CONST uint kShapeIsBoundary = 8u;    // between media

// Leaf info word z.
TACHYLITE_CONST uint kLeafKindMask = 0xffu;
TACHYLITE_CONST uint kLeafClassShift = 8u;
TACHYLITE_CONST uint kLeafClassMask = 0xffu;
TACHYLITE_CONST uint kLeafEmits = 1u << 16u;    // the shape is an area light that rays can find
TACHYLITE_CONST uint kLeafHides = 1u << 17u;    // the shape has an emitter of any kind: hide_emitters takes it away
TACHYLITE_CONST uint kLeafWall = 1u << 18u;     // outside of the tree (shared/baked.h)
TACHYLITE_CONST uint kLeafShapeShift = 4u;      // of word w
TACHYLITE_CONST uint kClassNone = 0xffu;       // absorbs everything: no surface queue

TACHYLITE_SHARED_END
#endif
