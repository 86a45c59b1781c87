// The state of a path: rows of vec4, structure of arrays. Row r of path slot s is element r * capacity + s of
// kBindPaths, but rows 0 and 1 alternate: they are elements 2 s and 2 s + 1, to be written as one. Kernels write
// through the storage buffer, and read through the texel view or it (kFeatureStorageReads). Rows beyond kPathRowsBase exist only in scenes that need them.
//
// The slot of a path is a function of pixel and sample (shared/render_params.h); contributions are written to the
// slot. So an image does not depend on the order in which queues are filled.
#ifndef TACHYLITE_SHARED_PATH_STATE_H
#define TACHYLITE_SHARED_PATH_STATE_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

TACHYLITE_CONST uint kPathOrigin = 0u;      // o.xyz (device space); w: bits of the hit that the ray leaves (kNoHit)
TACHYLITE_CONST uint kPathDirection = 1u;   // d.xyz (unit); w: pdf of d [1/sr], 0 after a delta lobe or the camera
TACHYLITE_CONST uint kPathBeta = 2u;        // throughput; w: eta^2 to undo the radiance scaling in roulette
TACHYLITE_CONST uint kPathRadiance = 3u;    // L so far; w: key of the light selection at the last vertex
TACHYLITE_CONST uint kPathHit = 4u;         // bits of 2 * leaf + triangle; b1; b2; t
TACHYLITE_CONST uint kPathRowsBase = 5u;
TACHYLITE_CONST uint kPathMedium = 5u;      // media or null surfaces only (medium.h): bits of the medium; bits of the number of
                                            // edges; distance from the last vertex that is not null to o; unused
TACHYLITE_CONST uint kPathRowsMedia = 6u;

// A shadow ray: kShadowRows rows of vec4 at its place (of kBindShadow, laid out as a path's), where there is one
// (kQueueShadow).
//   row 0: o.xyz; bits of the hit that the ray leaves (ignored by the test)
//   row 1: d.xyz, not normalised: the light is at o + d; bits of the hit on the light (ignored by the test), or
//          kTargetPoint (nothing to ignore, tmax = 1), or kTargetInfinite (tmax = infinity)
//   row 2: contribution to L where nothing is in between; bits of the path's slot
//   row 3: media or null surfaces only: bits of the medium at o; unused
// Behind a null surface the rows become those of the rest of the ray (kernels/intersect_shadow_transmittance.comp).
TACHYLITE_CONST uint kShadowRows = 3u;
TACHYLITE_CONST uint kShadowRowsMedia = 4u;
TACHYLITE_CONST uint kTargetInfinite = 0xffffffffu;
TACHYLITE_CONST uint kTargetPoint = 0xfffffffeu;

TACHYLITE_SHARED_END
#endif
