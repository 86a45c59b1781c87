#include "reference/texture/bitmap.h"

#include <array>

namespace tachylite::reference {
namespace {

/// IEC 61966-2-1.
double decode_srgb(double x) {
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

double decode_byte(uint8_t byte, TexelFormat format) {
  static const std::array<double, 256> decoded = [] {
    std::array<double, 256> values{};
    for (size_t i = 0; i < 256; ++i) values[i] = decode_srgb(static_cast<double>(i) / 255);
    return values;
  }();
  return format == TexelFormat::kUnorm8Srgb ? decoded[byte] : byte / 255.0;
}

int wrap(int64_t i, int size, WrapMode mode) {
  const int64_t n = size;
  switch (mode) {
    case WrapMode::kClamp:
      return static_cast<int>(std::clamp<int64_t>(i, 0, n - 1));
    case WrapMode::kRepeat:
      return static_cast<int>(((i % n) + n) % n);
    case WrapMode::kMirror: {
      const int64_t j = ((i % (2 * n)) + 2 * n) % (2 * n);
      return static_cast<int>(j < n ? j : 2 * n - 1 - j);
    }
  }
  return 0;
}

/// The four texels around uv, [row][column], and the position between them.
struct Corners {
  dvec3 texel[2][2];
  dvec2 f;
};

Corners corners_around(const BitmapTexture& texture, const dvec2& uv) {
  const Bitmap& bitmap = *texture.bitmap;
  const dvec2 position = uv * dvec2(bitmap.width, bitmap.height) - 0.5;
  const dvec2 base = glm::floor(position);
  Corners result;
  result.f = position - base;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      const int x = wrap(static_cast<int64_t>(base.x) + column, bitmap.width, texture.wrap);
      const int y = wrap(static_cast<int64_t>(base.y) + row, bitmap.height, texture.wrap);
      result.texel[row][column] = texel_color(bitmap, texture.format, x, y);
    }
  }
  return result;
}

}  // namespace

dvec3 texel_color(const Bitmap& bitmap, TexelFormat format, int x, int y) {
  const size_t first = (static_cast<size_t>(y) * static_cast<size_t>(bitmap.width) + static_cast<size_t>(x)) *
                       static_cast<size_t>(bitmap.channels);
  dvec3 color;
  for (size_t c = 0; c < 3; ++c) {
    const size_t i = first + (bitmap.channels >= 3 ? c : 0);
    color[static_cast<int>(c)] =
        bitmap.floats.empty() ? decode_byte(bitmap.bytes[i], format) : double{bitmap.floats[i]};
  }
  return color;
}

dvec3 eval_bitmap(const BitmapTexture& texture, const dvec2& uv) {
  const Bitmap& bitmap = *texture.bitmap;
  if (!(std::abs(uv.x) < 1e9 && std::abs(uv.y) < 1e9)) return dvec3(0);
  if (texture.filter == FilterType::kNearest) {
    const int x = wrap(static_cast<int64_t>(std::floor(uv.x * bitmap.width)), bitmap.width, texture.wrap);
    const int y = wrap(static_cast<int64_t>(std::floor(uv.y * bitmap.height)), bitmap.height, texture.wrap);
    return texel_color(bitmap, texture.format, x, y);
  }
  const Corners c = corners_around(texture, uv);
  return glm::mix(glm::mix(c.texel[0][0], c.texel[0][1], c.f.x),
                  glm::mix(c.texel[1][0], c.texel[1][1], c.f.x), c.f.y);
}

dvec2 eval_bitmap_gradient(const BitmapTexture& texture, const dvec2& uv) {
  if (texture.filter == FilterType::kNearest || !(std::abs(uv.x) < 1e9 && std::abs(uv.y) < 1e9))
    return dvec2(0);
  const Corners c = corners_around(texture, uv);
  const double h00 = luminance(c.texel[0][0]), h01 = luminance(c.texel[0][1]);
  const double h10 = luminance(c.texel[1][0]), h11 = luminance(c.texel[1][1]);
  return dvec2(texture.bitmap->width * lerp(h01 - h00, h11 - h10, c.f.y),
               texture.bitmap->height * lerp(h10 - h00, h11 - h01, c.f.x));
}

}  // namespace tachylite::reference
