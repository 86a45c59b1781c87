// Participating media. Written by host/pack/pack_medium, read by medium/*.glsl. Device space; lengths in scene units.
//
// Medium (kBindMedia): kMediumRows rows of vec4 (words by their bits); medium m begins at row m * kMediumRows.
//   row 0: sigma_t [1/length]; kind (kMedium...) | number of lobes << 8
//   row 1: albedo = sigma_s / sigma_t; row of the first lobe
//          grid: first float of the majorants in kBindGrids; their number in x | y << 8 | z << 16; unused; row of the lobe
//          Majorants: the box is divided into that many cells; of each the largest sigma_t of all channels [1/length],
//          or a little more, x fastest.
//   grid: row 2, 3: lower and upper corner of the box outside of which there is nothing; w of row 2: scale of sigma_t
//         row 4..7: volume of sigma_t; row 8..11: volume of albedo
// Volume: row 0..2: device space to the grid's index space, in which voxel (i, j, k) is centred at i + 1/2 ...;
//   row 3: nx | ny << 16; nz | channels << 16 | filter << 24 | wrap << 28 (channels 0: constant); first float in
//   kBindGrids; unused. Constant: row 0 has its value.
// Lobe, one row, after all media: probability of this and all lobes before it; its own; g; unused.
//   The phase function is the sum of its lobes: Henyey-Greenstein, isotropic is g = 0.
#ifndef TACHYLITE_SHARED_MEDIUM_H
#define TACHYLITE_SHARED_MEDIUM_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

TACHYLITE_CONST uint kNoMedium = 0xffffu;
TACHYLITE_CONST uint kMediumRows = 12u;
TACHYLITE_CONST uint kVolumeRows = 4u;
TACHYLITE_CONST uint kMediumSigmaRow = 4u;
TACHYLITE_CONST uint kMediumAlbedoRow = 8u;
TACHYLITE_CONST uint kMaxLobes = 8u;

TACHYLITE_CONST uint kMediumHomogeneous = 0u;
TACHYLITE_CONST uint kMediumGrid = 1u;

TACHYLITE_CONST uint kVolumeNearest = 0u;    // filters
TACHYLITE_CONST uint kVolumeTrilinear = 1u;
TACHYLITE_CONST uint kVolumeClamp = 0u;      // wraps
TACHYLITE_CONST uint kVolumeRepeat = 1u;
TACHYLITE_CONST uint kVolumeMirror = 2u;

// kFeatureMedia: what occurs in the scene.
TACHYLITE_CONST uint kMediaPaths = 1u;        // paths count their depth themselves: null surfaces do not count
TACHYLITE_CONST uint kMediaHomogeneous = 2u;
TACHYLITE_CONST uint kMediaGrids = 4u;
TACHYLITE_CONST uint kMediaChromatic = 8u;    // some homogeneous sigma_t differs between channels
TACHYLITE_CONST uint kMediaBlended = 16u;     // some phase function has several lobes
TACHYLITE_CONST uint kMediaSegments = 32u;    // shade_segment samples point, spot and projector lights in homogeneous media
TACHYLITE_CONST uint kMediaColouredSigma = 64u;  // some grid of sigma_t has three channels
TACHYLITE_CONST uint kMediaAlbedoGrids = 128u;   // some albedo is a grid
TACHYLITE_CONST uint kMediaRepeated = 256u;      // some grid is repeated or mirrored outside of its box
TACHYLITE_CONST uint kMediaNearest = 512u;       // some grid is looked up without interpolation
TACHYLITE_CONST uint kMediaDense = 1024u;        // some majorants may exceed kMostMajorantDepth across their box
TACHYLITE_CONST uint kMediaUniformChannel = 2048u; // never set for a scene: the yardstick of tests/bench/media

// Surfaces without scattering that one shadow ray can pass.
TACHYLITE_CONST uint kMaxCrossings = 64u;
TACHYLITE_CONST uint kMajorantCells = 16u;    // at most, in each axis
// Tentative collisions of one ray in grids. A lane walks kWalksPerLane rays in turn, of dense media one, and Mesa
// 22.3.6 ends all its loops after 65535 iterations: collisions are half of them, because a loop over cells is inside,
// less what the crossing of cells and traversal need. What is not dense stays far below (20 standard deviations).
TACHYLITE_CONST uint kWalksPerLane = 8u;
TACHYLITE_CONST uint kMaxCollisionsDense = 28000u;
TACHYLITE_CONST uint kMaxCollisions = 3500u;
TACHYLITE_CONST float kMostMajorantDepth = 2500.0f;

// Shadow rays through grids play Russian roulette below it.
TACHYLITE_CONST float kLeastTransmittance = 0.1f;

TACHYLITE_SHARED_END
#endif
