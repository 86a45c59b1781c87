// The guide: for cells of the scene's diffuse surfaces, how indirect light arrives there, learned from photons before
// the render. Written by shade_surface (photons) and host/wavefront/photon_guide, read by path/guide.glsl.
//
// A cell is a hash of a cube of space and of the axis that the normal is nearest to; its edge is a power of two that
// grows with the distance from the camera, and is a quarter of that where a focuser is too near to have a table. Cells
// that share a hash share their light, which costs noise, not bias.
// A cell has one table and one more for each focuser, a sphere around shapes that throw light together. Light that comes
// from within a focuser counts in its table, by where on the disk of the sphere it is seen: that hardly depends on the
// place in the cell, as its direction does. The cell's first table has all other light.
// In a table the square [0, 1)^2 of numbers that sample a cosine-weighted direction (base/warp.glsl), or one towards the
// focuser (path/focus_cone.glsl), is cut into kGuideBins^2 bins, bin x + kGuideBins * y.
//
//   kBindPhotons: uint a bin: flux of the photons there, in units of 1 / kPhotonUnit of the mean photon's.
//   kBindGuide: kGuideCellBins texels (uvec2) a table. First the nodes of a quadtree over the square, whose children
//     (x + 2 y of the quadrant) follow at 4 * node + 1: x = the left half's probability, y = of each half that of its
//     lower quadrant, the left one's in the low 16 bits; all in 2^-16. Hierarchical sample warping (Clarberg, Jarosz,
//     Akenine-Moeller and Jensen 2005, "Wavelet Importance Sampling", section 4) keeps stratified numbers stratified.
//     From texel kGuideDensities on, two bins a texel: bits of the density w.r.t. area of the square, mean 1 over a table.
//     Texel kGuideShares of a cell's first table: 16 bits each of the focusers' shares of the samples, and of the share
//     that follows the bsdf alone, in 1 / 65535. Multiple importance sampling goes by the latter: photons tell nothing of
//     the light that light samples find, and its weights may be any that both techniques agree on. Of a cell without photons
//     that share is 1, nothing else is written, and the first table after the cells, which is uniform, stands in.
#ifndef TACHYLITE_SHARED_GUIDE_H
#define TACHYLITE_SHARED_GUIDE_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

TACHYLITE_CONST uint kGuideLevels = 4u;
TACHYLITE_CONST uint kGuideBins = 16u;  // 2^kGuideLevels
TACHYLITE_CONST uint kGuideCellBins = 256u;  // kGuideBins^2
TACHYLITE_CONST uint kGuideDensities = 128u;
TACHYLITE_CONST uint kGuideShares = 96u;
TACHYLITE_CONST uint kGuideCells = 4096u;
TACHYLITE_CONST uint kMaxFocusers = 3u;
TACHYLITE_CONST uint kPhotonBits = 20u;  // 2^kPhotonBits photons at most
TACHYLITE_CONST float kPhotonUnit = 256.0f;

TACHYLITE_CONST float kCausticUnit = 16.0f;
TACHYLITE_CONST float kFocusedPdf = 1.0f;  // [1/sr] of a lobe, three times that of the cosine; 0: delta lobes

TACHYLITE_SHARED_END
#endif
