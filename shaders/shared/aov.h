// Auxiliary output variables: values of the first surface that a camera ray hits, summed over the samples of a block.
// kBindAov: rows of vec4; row r of pixel-and-block i is element r * kBindAov's stride (RenderParams::aov_stride) + i.
// The rows are those of the set kFeatureAov, in ascending order of kind.
#ifndef TACHYLITE_SHARED_AOV_H
#define TACHYLITE_SHARED_AOV_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

TACHYLITE_CONST uint kAovAlbedo = 0u;      // bsdf/albedo.glsl
TACHYLITE_CONST uint kAovDepth = 1u;       // distance along the ray from the near clip plane
TACHYLITE_CONST uint kAovPosition = 2u;    // device space
TACHYLITE_CONST uint kAovUv = 3u;
TACHYLITE_CONST uint kAovGeoNormal = 4u;
TACHYLITE_CONST uint kAovShNormal = 5u;
TACHYLITE_CONST uint kAovDpDu = 6u;
TACHYLITE_CONST uint kAovDpDv = 7u;
TACHYLITE_CONST uint kAovPrimIndex = 8u;   // of the triangle in its mesh, 0 of other shapes
TACHYLITE_CONST uint kAovShapeIndex = 9u;
TACHYLITE_CONST uint kAovMoment = 10u;     // squares of the samples' radiance
TACHYLITE_CONST uint kAovKinds = 11u;      // that kernels write
TACHYLITE_CONST uint kAovSampleCount = 11u; // the host counts

TACHYLITE_SHARED_END
#endif
