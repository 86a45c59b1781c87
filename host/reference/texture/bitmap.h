#pragma once

#include "reference/math.h"
#include "scene/scene.h"

namespace tachylite::reference {

/// Linear colour of texel (x, y), row 0 on top; 8-bit sRGB is decoded before any filtering, grey is
/// replicated.
dvec3 texel_color(const Bitmap& bitmap, TexelFormat format, int x, int y);

/// v = 0 is the top row. Texel centres lie at (i + 0.5) / resolution, and the wrap mode acts on texel
/// numbers.
dvec3 eval_bitmap(const BitmapTexture& texture, const dvec2& uv);
/// Gradient of the bilinear interpolant of the luminance w.r.t. uv: resolution times texel differences.
dvec2 eval_bitmap_gradient(const BitmapTexture& texture, const dvec2& uv);

}  // namespace tachylite::reference
