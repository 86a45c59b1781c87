// Lights. Written by host/pack/pack_light, read by light/*.glsl. Device space; radiometric values in linear Rec.709.
//
// Light (kBindLights): kLightRows rows of vec4, one record a primitive that emits, or a light without a shape.
//   Every primitive of an emitting shape has a record of its own; those of a mesh follow each other in the order of
//   its triangles, one a triangle, or one for each two triangles that form a rectangle. Shape row 0 names the first.
//   row 0: radiance Le [W/sr/m^2] (point, spot: intensity I [W/sr]; directional: irradiance [W/m^2];
//          spot, projector: times the texture); bits of kind | flags
//   row 1..5, by kind:
//     triangle, rectangle: 1: v0; hit of triangle 0      2: e1; texture row      3: e2; hit of triangle 1
//                          4: n (unit, the side that emits); area                5: first triangle; where (y);
//                             row of the corners' data (kNoIndex: none); where (w)
//       A triangle is v0 + b1 e1 + b2 e2; a rectangle v0 + s e1 + t e2, e1 orthogonal to e2, whose triangle 0 is the
//       half with s + t < 1.
//     sphere:   1: centre; hit    2: radius, 1 if it emits inwards, unused; texture row    3..4: unused   5: as above
//     disk:     1: centre; hit    2: e1; texture row   3: e2; unused   4: n; area          5: as above
//               An ellipse: centre + r (e1 cos phi + e2 sin phi).
//     cylinder: 1: base; hit      2: e1; texture row   3: e2; 1 if it emits inwards   4: axis; unused   5: as above
//               base + e1 cos phi + e2 sin phi + z axis, 0 <= z <= 1.
//     constant: nothing more
//     environment: 1..3: rows of the rotation from world to the map; w: width, height (bits), unused
//     point:    1: position
//     directional: 1: direction towards the light
//     spot:     1..3: rows of the transform of directions from world to the light's frame; w: position
//               4: cos and angle of the cutoff, cos of the beam width, 1 / (cutoff - beam width) [radians]
//               5: texture row; tan of the cutoff
//     projector: 1..3: as spot; 4: 1 / tan(x_fov / 2), the same times aspect, cos of the corner, unused; 5: as spot
//   Corners' data, where the radiance is a texture or the mesh has vertex normals, after all lights:
//     row 0: uv of v0, uv of v0 + e1     row 1: uv of v0 + e2; unused     rows 2..4: vertex normals (smooth lights);
//        row 2, w: 1 / (area of the mesh * number of emitters)
//
// Table (kBindLightTable): rows of uvec4, floats by their bits.
//   row 0: number of units; unused; environment's first light row (kNoIndex: none); importance of the environment (bits)
//   then groups of children, kLightNodeRows rows each child: first the units that are chosen among at the top, then the
//   nodes' children, at most kLightNodeWidth each. "Light bounds" as in Conty Estevez and Kulla 2018, "Importance
//   Sampling of Many Lights with Adaptive Tree Splitting":
//     row 0: centre; radius of the sphere around it, negative for infinite lights
//     row 1: axis of the cone of normals; power: the irradiance at p is about power * cos(theta') / (d^2 + radius^2 / 2),
//            of infinite lights power itself
//     row 2: cos theta_o; sin theta_o; cos theta_e; light row, or a node: kLightNode | (number of children - 1) << 28 |
//            number of its first child, counted from row kLightTableHeaderRows on
//   Where a light is (row 5 of area lights): words y, w of "trail or unit" = number of its unit | trail << 8, and the
//   trail's next bits: three a level below the unit, from the lowest bits on, 8 levels in y and 10 in w.
#ifndef TACHYLITE_SHARED_LIGHT_H
#define TACHYLITE_SHARED_LIGHT_H
#include "features.h"
#include "interop.h"
TACHYLITE_SHARED_BEGIN

TACHYLITE_CONST uint kLightRows = 6u;
TACHYLITE_CONST uint kLightNodeRows = 3u;
TACHYLITE_CONST uint kLightNodeWidth = 8u;
TACHYLITE_CONST uint kLightNode = 0x80000000u;
TACHYLITE_CONST uint kLightNodeCountShift = 28u;
TACHYLITE_CONST uint kLightNodeFirstMask = 0x0fffffffu;
TACHYLITE_CONST uint kLightTrailLevels = 18u;
TACHYLITE_CONST uint kLightTableHeaderRows = 1u;
// More lights are put into a tree. One sample by the loop over 16 or 32 takes 130 or 208 ns on Mesa 22.3.6, 213 or 396 ns
// on 25.0.7, with a relative variance of 0.08 or 0.29; by the tree over 33 both take 142 ns, at 0.66.
TACHYLITE_CONST uint kMaxLoopLights = 16u;

// Row 0, word w.
TACHYLITE_CONST uint kLightKindMask = 0xffu;
TACHYLITE_CONST uint kLightSmooth = 1u << 8u;   // emission is seen by vertex normals
TACHYLITE_CONST uint kLightPairs = 1u << 9u;    // two triangles of the shape to a record

// Bits of the set of light kinds (kFeatureLights) that are no kinds.
TACHYLITE_CONST uint kLightsSmooth = 16u;      // some light is smooth
TACHYLITE_CONST uint kLightsSphericalRectangles = 17u; // some rectangle is so large that solid angle pays
TACHYLITE_CONST uint kLightsSampledConstant = 18u;     // the constant environment is among the lights to sample

TACHYLITE_SHARED_END
#endif
