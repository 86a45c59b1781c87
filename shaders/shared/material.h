// Materials, flattened from the scene's tree of bsdfs into leaves with weights, so that a kernel needs no recursion.
// Written by host/pack/pack_material, read by bsdf/bsdf.glsl. Rows of uvec4 (floats by their bits) in kBindMaterials.
//
// f(wo, wi) of a material = sum over its leaves of weight_i * f_i, plus a `null` part that lets light straight on,
// whose weight is 1 - sum of weight_i (`mask`, `paper`, `blendbsdf` keep the sum of all weights at 1). Two lists of
// leaves, for a viewer in front (cos_wo > 0) and behind: `twosided` decides which leaf stands in which.
//
// Material: row 0 = (number of leaves in front | behind << 8, flags kMaterial..., first leaf in front, first leaf
//   behind). Both lists may be the same. Where the flags lack kMaterialSides the one list begins in row 1.
// Leaf, from its first row on:
//   row 0: type (kBsdf...) | mirrors << 8 | sides << 12 | options << 16; number of weights | row of the first weight
//          (counted from the leaf's first row) << 16; frame kind | frame options << 8, of the map inside it, if any,
//          << 16; rows to the next leaf
//   then the inputs and constants of its type, as its file in shaders/bsdf says; then, for each frame kind that is not
//   kFrameNone, one row (scale bits, unused, unused, texture row), the outer one first; then the weights, one scalar
//   input each (kInputComplement in the texture word: use 1 - value). A weight is clamped to [0, 1].
// Input (one row): (r, g, b as float bits; row of the texture in kBindTextures, or kNoTexture). A weight has its value
//   in r. Other scalars come as a pair (two values, two texture rows) or a quad (a row of values, a row of texture
//   rows; the latter is read only where the class says that one is a texture).
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

// Mirrors of a leaf: wo and wi are mirrored to the front (z negated where wo is behind) before the normal or bump map
// turns the frame, after it, and after the map inside that one. Bit i: after i maps.
TACHYLITE_CONST uint kMirrorOuter = 1u;
TACHYLITE_CONST uint kMirrorInner = 2u;
TACHYLITE_CONST uint kMirrorInnermost = 4u;

// Sides of a leaf: it is there only for viewers in front of, or behind, the frame inside the outer map, and that inside
// the map in it (`twosided` with two bsdfs within maps). The leaves of both sides stand in the list.
TACHYLITE_CONST uint kSideShift = 12u;
TACHYLITE_CONST uint kSideFrontInner = 1u;
TACHYLITE_CONST uint kSideBackInner = 2u;
TACHYLITE_CONST uint kSideFrontInnermost = 4u;
TACHYLITE_CONST uint kSideBackInnermost = 8u;

// Options of a leaf.
TACHYLITE_CONST uint kOptionGgx = 1u;          // else Beckmann

TACHYLITE_CONST uint kFrameNone = 0u;
TACHYLITE_CONST uint kFrameNormalMap = 1u;
TACHYLITE_CONST uint kFrameBumpMap = 2u;
TACHYLITE_CONST uint kFrameFlipInvalid = 1u;   // options of a frame
TACHYLITE_CONST uint kFrameShadowing = 2u;
TACHYLITE_CONST uint kMostFrames = 2u;         // inside one another

TACHYLITE_CONST uint kNoTexture = 0x7fffffffu;
TACHYLITE_CONST uint kInputComplement = 0x80000000u;  // on a weight: 1 - value
// Set of the inputs that are textures in some material of a class (kFeatureTexturedInputs): bit i is row i after the
// leaf's header.
TACHYLITE_CONST uint kTexturedWeights = 1u << 31u;

// Flags of a material, also of the class a kernel is compiled for.
TACHYLITE_CONST uint kMaterialHasWeights = 1u;   // some leaf has weights
TACHYLITE_CONST uint kMaterialHasFrames = 2u;    // normal or bump maps
TACHYLITE_CONST uint kMaterialTextured = 4u;     // some input is a texture: uv is needed
TACHYLITE_CONST uint kMaterialTangent = 8u;      // the tangent matters: anisotropy, normal or bump maps
TACHYLITE_CONST uint kMaterialSmooth = 16u;      // some leaf has a non-delta lobe: sampling lights makes sense
TACHYLITE_CONST uint kMaterialDelta = 32u;       // some leaf has a delta lobe
TACHYLITE_CONST uint kMaterialBeckmann = 64u;
TACHYLITE_CONST uint kMaterialGgx = 128u;
TACHYLITE_CONST uint kMaterialTwoSided = 256u;   // every leaf has kMirrorOuter
TACHYLITE_CONST uint kMaterialSides = 512u;      // lists of front and back differ, or only some leaves mirror
TACHYLITE_CONST uint kMaterialNull = 1024u;      // a null part: shadow rays may pass
TACHYLITE_CONST uint kMaterialTransmits = 2048u; // principled: spec_trans
TACHYLITE_CONST uint kMaterialClearcoat = 4096u; // principled: clearcoat
TACHYLITE_CONST uint kMaterialNestedFrames = 8192u;  // a normal or bump map inside another
TACHYLITE_CONST uint kMaterialMapSides = 16384u; // some leaf has sides
TACHYLITE_CONST uint kMaterialMaxLeaves = 8u;    // in one list
TACHYLITE_CONST uint kRoughTransmittanceSize = 64u;  // entries of roughplastic's table

TACHYLITE_SHARED_END
#endif
