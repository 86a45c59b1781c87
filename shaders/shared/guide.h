// The guide: for cells of the scene's diffuse surfaces, how indirect light arrives there, learned from photons before
// the render. Written by shade_surface (photons) and host/wavefront/photon_guide, read by path/guide.glsl.
//
// A cell is a hash of a cube of space and of the axis that the normal is nearest to; its edge is a power of two that
// grows with the distance from the camera. Cells that share a hash share their light, which costs noise, not bias.
// In a cell the square [0, 1)^2 of numbers that sample a cosine-weighted direction (base/warp.glsl) is cut into
// kGuideBins^2 bins, bin x + kGuideBins * y.
//
//   kBindPhotons: uint a bin: flux of the photons there, in units of 1 / kPhotonUnit of the mean photon's.
//   kBindGuide: kGuideCellBins texels (uvec2) a cell. First the nodes of a quadtree over the square, whose children
//     (x + 2 y of the quadrant) follow at 4 * node + 1: x = the left half's probability, y = of each half that of its
//     lower quadrant, the left one's in the low 16 bits; all in 2^-16. Hierarchical sample warping (Clarberg, Jarosz,
//     Akenine-Moeller and Jensen 2005, "Wavelet Importance Sampling", section 4) keeps stratified numbers stratified.
//     From texel kGuideDensities on, two bins a texel: bits of the density w.r.t. area of the square, mean 1 over a cell.
#ifndef TACHYLITE_SHARED_GUIDE_H
#define TACHYLITE_SHARED_GUIDE_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

TACHYLITE_CONST uint kGuideLevels = 4u;
TACHYLITE_CONST uint kGuideBins = 16u;  // 2^kGuideLevels
TACHYLITE_CONST uint kGuideCellBins = 256u;  // kGuideBins^2
TACHYLITE_CONST uint kGuideDensities = 128u;
TACHYLITE_CONST uint kGuideCells = 8192u;
TACHYLITE_CONST float kPhotonUnit = 256.0f;

TACHYLITE_CONST float kCausticUnit = 16.0f;
TACHYLITE_CONST float kFocusedPdf = 1.0f;  // [1/sr] of a lobe, three times that of the cosine; 0: delta lobes

TACHYLITE_SHARED_END
#endif
