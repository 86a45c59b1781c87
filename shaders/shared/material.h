// Materials, flattened from the scene's tree of bsdfs into leaves with weights, so that a kernel needs no recursion.
// Written by host/pack/pack_material, read by bsdf/bsdf.glsl. Rows of uvec4 (floats by their bits) in kBindMaterials.
//
// f(wo, wi) of a material = sum over its leaves of weight_i * f_i. `mask` and `paper` are a `null` leaf (light goes
// straight on) beside the others; `blendbsdf` multiplies weights; `twosided` sets the sides a leaf serves.
//
// Material: row 0 = (number of leaves, flags kMaterial..., row of the first leaf, unused).
// Leaf, from its first row on:
//   row 0: type (kBsdf...) | sides << 8 | options << 16; number of weights; frame kind | frame texture << 8;
//          rows to the next leaf
//   row 1: frame parameters (kFrameNormalMap, kFrameBumpMap): scale bits, options, unused, unused
//   then `number of weights` inputs (scalar; options bit 31 of the texture word: use 1 - value), then the bsdf's own
//   inputs and constants, as its file in shaders/bsdf says.
// Input (one row): (r, g, b as float bits; texture word: row of the texture in kBindTextures, or kNoTexture).
//   A scalar input repeats its value in r g b.
#ifndef TACHYLITE_SHARED_MATERIAL_H
#define TACHYLITE_SHARED_MATERIAL_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

// Leaf types; bit 1 << type stands in the set of types a kernel is compiled for.
TACHYLITE_CONST uint kBsdfNull = 0u;
TACHYLITE_CONST uint kBsdfDiffuse = 1u;
TACHYLITE_CONST uint kBsdfRoughDiffuse = 2u;
TACHYLITE_CONST uint kBsdfConductor = 3u;
TACHYLITE_CONST uint kBsdfRoughConductor = 4u;
TACHYLITE_CONST uint kBsdfDielectric = 5u;
TACHYLITE_CONST uint kBsdfThinDielectric = 6u;
TACHYLITE_CONST uint kBsdfRoughDielectric = 7u;
TACHYLITE_CONST uint kBsdfPlastic = 8u;
TACHYLITE_CONST uint kBsdfRoughPlastic = 9u;
TACHYLITE_CONST uint kBsdfPrincipled = 10u;
TACHYLITE_CONST uint kBsdfPrincipledThin = 11u;
TACHYLITE_CONST uint kBsdfBlinnPhong = 12u;
TACHYLITE_CONST uint kBsdfMicrofacet = 13u;

// Sides a leaf serves: light seen from the front (cos_wo > 0), the back, or both by mirroring wo and wi to the front
// (kSideMirror: what `twosided` does with its child).
TACHYLITE_CONST uint kSideFront = 1u;
TACHYLITE_CONST uint kSideBack = 2u;
TACHYLITE_CONST uint kSideMirror = 4u;   // z of both directions is negated when wo is behind

// Options of a leaf (which of them matter depends on the type).
TACHYLITE_CONST uint kOptionGgx = 1u;          // else Beckmann
TACHYLITE_CONST uint kOptionNonlinear = 2u;    // plastic, roughplastic
TACHYLITE_CONST uint kOptionAnisotropic = 4u;
TACHYLITE_CONST uint kOptionSpecularWeight = 8u; // blinnphong

TACHYLITE_CONST uint kFrameNone = 0u;
TACHYLITE_CONST uint kFrameNormalMap = 1u;
TACHYLITE_CONST uint kFrameBumpMap = 2u;
TACHYLITE_CONST uint kFrameFlipInvalid = 1u;   // options of a frame
TACHYLITE_CONST uint kFrameShadowing = 2u;

TACHYLITE_CONST uint kNoTexture = 0x7fffffffu;
TACHYLITE_CONST uint kInputComplement = 0x80000000u;  // on a weight: 1 - value

// Flags of a material, also of the class a kernel is compiled for.
TACHYLITE_CONST uint kMaterialHasWeights = 1u;   // some leaf has a weight other than 1
TACHYLITE_CONST uint kMaterialHasFrames = 2u;    // normal or bump maps
TACHYLITE_CONST uint kMaterialTextured = 4u;     // some input is a texture: uv is needed
TACHYLITE_CONST uint kMaterialTangent = 8u;      // the tangent matters: anisotropy, normal or bump maps
TACHYLITE_CONST uint kMaterialSmooth = 16u;      // some leaf has a non-delta lobe: sampling lights makes sense
TACHYLITE_CONST uint kMaterialDelta = 32u;       // some leaf has a delta lobe
TACHYLITE_CONST uint kMaterialBeckmann = 64u;
TACHYLITE_CONST uint kMaterialGgx = 128u;
TACHYLITE_CONST uint kMaterialTwoSided = 256u;   // some leaf mirrors or serves the back

TACHYLITE_SHARED_END
#endif
