// Binding numbers of descriptor set 0. "texel" is a read-only texel buffer, "storage" a storage buffer that kernels
// write, unless it is a view. A buffer that a scene does not need is not allocated; a few zeros stand in for it.
#ifndef TACHYLITE_SHARED_BINDINGS_H
#define TACHYLITE_SHARED_BINDINGS_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

TACHYLITE_CONST uint kBindParams = 0u;         // uniform RenderParams
// Geometry
TACHYLITE_CONST uint kBindBvhNodes = 1u;       // texel RGBA32UI, shared/bvh.h
TACHYLITE_CONST uint kBindBvhLeaves = 2u;      // texel RGBA32F, shared/bvh.h
TACHYLITE_CONST uint kBindLeafInfo = 3u;       // texel RGBA32UI view of the same, shared/geometry.h
TACHYLITE_CONST uint kBindTriangles = 4u;      // texel RGBA32UI, shared/geometry.h
TACHYLITE_CONST uint kBindUvs = 5u;            // texel RG32F, of vertices
TACHYLITE_CONST uint kBindNormals = 6u;        // texel RGBA32F: xyz, of vertices (zero: flat)
TACHYLITE_CONST uint kBindCurved = 7u;         // texel RGBA32F, shared/geometry.h
TACHYLITE_CONST uint kBindShapes = 8u;         // texel RGBA32UI, shared/geometry.h
TACHYLITE_CONST uint kBindAttributes = 9u;     // texel RGBA32F, mesh attributes
// Appearance
TACHYLITE_CONST uint kBindMaterials = 10u;     // texel RGBA32UI, shared/material.h
TACHYLITE_CONST uint kBindTextures = 11u;      // texel RGBA32UI, shared/texture.h
TACHYLITE_CONST uint kBindTexels8 = 12u;       // texel RGBA8_UNORM
TACHYLITE_CONST uint kBindTexels16 = 13u;      // texel RGBA16_SFLOAT
TACHYLITE_CONST uint kBindTexels32 = 14u;      // texel RGBA32_SFLOAT
// Lights
TACHYLITE_CONST uint kBindLights = 15u;        // texel RGBA32F, shared/light.h
TACHYLITE_CONST uint kBindLightTable = 16u;    // texel RGBA32UI, selection tables and emissive triangles
TACHYLITE_CONST uint kBindEnvironment = 17u;   // texel RGBA32F: radiance of the environment's texels
TACHYLITE_CONST uint kBindEnvironmentCdf = 18u; // texel RGBA32F, the environment's sampling tables
// Media
TACHYLITE_CONST uint kBindMedia = 19u;         // texel RGBA32F
TACHYLITE_CONST uint kBindGrids = 20u;         // texel R32F
TACHYLITE_CONST uint kBindBaked = 30u;         // texel RGBA32F, shared/baked.h
// Paths
TACHYLITE_CONST uint kBindPathTexels = 21u;    // texel RGBA32F view of the path state (reads)
TACHYLITE_CONST uint kBindPaths = 22u;         // storage: path state (writes), shared/path_state.h
TACHYLITE_CONST uint kBindQueueTexels = 23u;   // texel R32UI view of the queues (reads)
TACHYLITE_CONST uint kBindQueues = 24u;        // storage: queues of path slots (writes)
TACHYLITE_CONST uint kBindShadowTexels = 25u;  // texel RGBA32F view of the shadow rays (reads)
TACHYLITE_CONST uint kBindShadow = 26u;        // storage: shadow rays (writes)
TACHYLITE_CONST uint kBindCounters = 27u;      // storage: queue lengths, dispatch arguments, statistics
TACHYLITE_CONST uint kBindFilm = 28u;          // storage: sums of a block of samples
TACHYLITE_CONST uint kBindAov = 29u;           // storage: sums of the AOVs
TACHYLITE_CONST uint kBindPixelList = 31u;     // texel RG32UI: pixels of a wave, shared/render_params.h
// Guiding
TACHYLITE_CONST uint kBindEmission = 32u;      // texel R32F: photons of the lights up to each, as a share of all
TACHYLITE_CONST uint kBindPhotons = 33u;       // storage: flux of photons, shared/guide.h
TACHYLITE_CONST uint kBindGuide = 34u;         // texel RG32UI, shared/guide.h
// Views of the tree where kernels read it so (kFeatureStorageReads)
TACHYLITE_CONST uint kBindBvhNodeRows = 35u;   // storage: rows of kBindBvhNodes
TACHYLITE_CONST uint kBindBvhLeafRows = 36u;   // storage: rows of kBindBvhLeaves

TACHYLITE_SHARED_END
#endif
