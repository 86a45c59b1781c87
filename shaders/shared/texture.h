// Textures. Written by host/pack/pack_texture, read by texture/texture.glsl. kTextureRows rows of uvec4 in
// kBindTextures each:
//   row 0: kind | format << 4 | filter << 8 | wrap << 12 | channels << 16; first texel; width; height
//   row 1: to_uv row 0 (m00, m01, m02 as float bits); unused
//   row 2: to_uv row 1; unused             (not for mesh attributes)
//   checkerboard: row 3: color0 bits, w: 1 + row of the texture that is there instead, or 0; row 4: color1, the same
//   mesh attribute: row 0: kind | per vertex << 4; first row in kBindAttributes; first triangle; number of triangles;
//                   row 3: scale bits. Rows of a triangle outside that range count as 0.
// Attribute values (kBindAttributes, vec4 rows): one a triangle (face attributes), or three a triangle, of its
// vertices 0, 1, 2 (vertex attributes), so that a lookup needs no vertex numbers.
#ifndef TACHYLITE_SHARED_TEXTURE_H
#define TACHYLITE_SHARED_TEXTURE_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

TACHYLITE_CONST uint kTextureRows = 5u;

TACHYLITE_CONST uint kTextureBitmap = 0u;
TACHYLITE_CONST uint kTextureCheckerboard = 1u;
TACHYLITE_CONST uint kTextureAttribute = 2u;
TACHYLITE_CONST uint kTexel8Srgb = 0u;    // RGBA8 in kBindTexels8, decoded by the sRGB curve
TACHYLITE_CONST uint kTexel8Linear = 1u;  // RGBA8 in kBindTexels8
TACHYLITE_CONST uint kTexelHalf = 2u;     // RGBA16F in kBindTexels16
TACHYLITE_CONST uint kTexelFloat = 3u;    // RGBA32F in kBindTexels32
// Fields of row 0, word x.
TACHYLITE_CONST uint kTextureKindMask = 0xfu;
TACHYLITE_CONST uint kTextureFormatShift = 4u;
TACHYLITE_CONST uint kTextureFilterShift = 8u;
TACHYLITE_CONST uint kTextureWrapShift = 12u;
TACHYLITE_CONST uint kTextureChannelShift = 16u;
TACHYLITE_CONST uint kAttributePerVertex = 1u << 4u;
TACHYLITE_CONST uint kFilterNearest = 0u;
TACHYLITE_CONST uint kFilterBilinear = 1u;
TACHYLITE_CONST uint kWrapRepeat = 0u;
TACHYLITE_CONST uint kWrapMirror = 1u;
TACHYLITE_CONST uint kWrapClamp = 2u;
TACHYLITE_CONST uint kMostCheckerboards = 4u;  // inside one another

// kFeatureTextures: which of the above occur in the scene.
TACHYLITE_CONST uint kTexturesBitmap = 1u << 0u;
TACHYLITE_CONST uint kTexturesCheckerboard = 1u << 1u;
TACHYLITE_CONST uint kTexturesAttribute = 1u << 2u;
TACHYLITE_CONST uint kTexturesTransform = 1u << 3u;  // some to_uv is not the identity
TACHYLITE_CONST uint kTextures8Srgb = 1u << 4u;
TACHYLITE_CONST uint kTextures8Linear = 1u << 5u;
TACHYLITE_CONST uint kTexturesHalf = 1u << 6u;
TACHYLITE_CONST uint kTexturesFloat = 1u << 7u;
TACHYLITE_CONST uint kTexturesNearest = 1u << 8u;
TACHYLITE_CONST uint kTexturesBilinear = 1u << 9u;
TACHYLITE_CONST uint kTexturesRepeat = 1u << 12u;
TACHYLITE_CONST uint kTexturesMirror = 1u << 13u;
TACHYLITE_CONST uint kTexturesClamp = 1u << 14u;
TACHYLITE_CONST uint kTexturesNested = 1u << 15u;  // some square of a checkerboard is a texture

TACHYLITE_SHARED_END
#endif
