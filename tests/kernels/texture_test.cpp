// Texture lookups on the device against the same in double on the host, written after scene-format's words: texel
// centres at (i + 0.5) / resolution, row 0 on top, wrapping of texel indices.

#include <bit>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include "pack/pack_geometry.h"
#include "pack/pack_texture.h"
#include "shared/bindings.h"
#include "shared/features.h"
#include "shared/texture.h"
#include "support/device_test.h"

namespace tachylite {
namespace {

using test::DeviceTest;
using test::KernelRun;
constexpr int kPoints = 3000;

struct Lookup {
  glm::vec4 color;  // w: luminance
  glm::vec2 gradient;
};

template <class T, class Allocator>
std::span<const T> at_least_one(std::vector<T, Allocator>& values) {
  if (values.empty()) values.resize(1);
  return values;
}

std::vector<Lookup> look_up(const Scene& scene, size_t texture, std::span<const glm::vec4> points) {
  PackedTextures packed = pack_textures(scene, pack_geometry(scene));
  constexpr VkFormat kFloat4 = VK_FORMAT_R32G32B32A32_SFLOAT;
  struct Push {
    uint32_t count, row;
  };
  KernelRun run("texture_lookup");
  run.texels(gpu::kBindTextures, VK_FORMAT_R32G32B32A32_UINT, at_least_one(packed.rows))
      .texels(gpu::kBindTexels8, VK_FORMAT_R8G8B8A8_UNORM, at_least_one(packed.texels8))
      .texels(gpu::kBindTexels16, VK_FORMAT_R16G16B16A16_SFLOAT, at_least_one(packed.texels16))
      .texels(gpu::kBindTexels32, kFloat4, at_least_one(packed.texels32))
      .texels(gpu::kBindAttributes, kFloat4, at_least_one(packed.attributes))
      .constant(gpu::kFeatureTextures, packed.kinds)
      .storage(64, points)
      .output<glm::vec4>(65, 2 * points.size())
      .push(Push{static_cast<uint32_t>(points.size()), packed.row_of_texture[texture]})
      .run(points.size());
  const auto rows = run.result<glm::vec4>(65);
  std::vector<Lookup> results(points.size());
  for (size_t i = 0; i < results.size(); ++i) results[i] = {rows[2 * i], glm::vec2(rows[2 * i + 1])};
  return results;
}

double luminance(const dvec3& c) { return 0.212671 * c.x + 0.715160 * c.y + 0.072169 * c.z; }

int wrapped(int i, int n, WrapMode wrap) {
  if (wrap == WrapMode::kClamp) return std::clamp(i, 0, n - 1);
  const int period = wrap == WrapMode::kMirror ? 2 * n : n, m = ((i % period) + period) % period;
  return m < n ? m : 2 * n - 1 - m;
}

/// Bitmap lookup in double; exact sRGB.
struct ExactBitmap {
  const Texture& texture;
  const BitmapTexture& bitmap = std::get<BitmapTexture>(texture.kind);

  dvec3 texel(int x, int y) const {
    const Bitmap& b = *bitmap.bitmap;
    const int i = (wrapped(y, b.height, bitmap.wrap) * b.width + wrapped(x, b.width, bitmap.wrap)) * b.channels;
    dvec3 color;
    for (int c = 0; c < 3; ++c) {
      const auto k = static_cast<size_t>(i + (b.channels >= 3 ? c : 0));
      double v = b.bytes.empty() ? double{b.floats[k]} : b.bytes[k] / 255.0;
      if (bitmap.format == TexelFormat::kUnorm8Srgb) v = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
      color[c] = v;
    }
    return color;
  }
  dvec2 position(const dvec2& uv) const {
    return dvec2(texture.to_uv * dvec3(uv, 1)) * dvec2(bitmap.bitmap->width, bitmap.bitmap->height);
  }
  dvec3 color(const dvec2& uv) const {
    const dvec2 p = position(uv);
    if (bitmap.filter == FilterType::kNearest)
      return texel(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)));
    const dvec2 q = p - 0.5, f = q - glm::floor(q);
    const int x = static_cast<int>(std::floor(q.x)), y = static_cast<int>(std::floor(q.y));
    return (1 - f.y) * ((1 - f.x) * texel(x, y) + f.x * texel(x + 1, y)) +
           f.y * ((1 - f.x) * texel(x, y + 1) + f.x * texel(x + 1, y + 1));
  }
  dvec2 gradient(const dvec2& uv) const {
    if (bitmap.filter == FilterType::kNearest) return dvec2(0);
    const dvec2 q = position(uv) - 0.5, f = q - glm::floor(q);
    const int x = static_cast<int>(std::floor(q.x)), y = static_cast<int>(std::floor(q.y));
    const double c00 = luminance(texel(x, y)), c10 = luminance(texel(x + 1, y)), c01 = luminance(texel(x, y + 1)),
                 c11 = luminance(texel(x + 1, y + 1));
    const dvec2 d((1 - f.y) * (c10 - c00) + f.y * (c11 - c01), (1 - f.x) * (c01 - c00) + f.x * (c11 - c10));
    const dvec2 g = d * dvec2(bitmap.bitmap->width, bitmap.bitmap->height);
    const dmat3& m = texture.to_uv;
    return {m[0][0] * g.x + m[0][1] * g.y, m[1][0] * g.x + m[1][1] * g.y};
  }
  /// Distance, in texels, to where the lookup jumps (nearest) or its gradient does (bilinear).
  double to_edge(const dvec2& uv) const {
    const dvec2 p = position(uv) + (bitmap.filter == FilterType::kNearest ? 0.0 : 0.5);
    const dvec2 d = glm::abs(p - glm::round(p));
    return std::min(d.x, d.y);
  }
};

std::shared_ptr<const Bitmap> random_bitmap(int width, int height, int channels, TexelFormat format, uint32_t seed) {
  std::mt19937 random(seed);
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = width;
  bitmap->height = height;
  bitmap->channels = channels;
  bitmap->half = format == TexelFormat::kHalf;
  for (int i = 0; i < width * height * channels; ++i) {
    const auto byte = static_cast<uint8_t>(random() >> 24);
    if (format == TexelFormat::kUnorm8Srgb || format == TexelFormat::kUnorm8Linear)
      bitmap->bytes.push_back(byte);
    else if (format == TexelFormat::kHalf)
      bitmap->floats.push_back(glm::unpackHalf1x16(glm::packHalf1x16(static_cast<float>(byte) * 0.37f)));
    else
      bitmap->floats.push_back(static_cast<float>(random()) * 1e-6f);
  }
  return bitmap;
}

Texture bitmap_texture(std::shared_ptr<const Bitmap> bitmap, TexelFormat format, WrapMode wrap, FilterType filter,
                       const dmat3& to_uv) {
  Texture texture;
  texture.to_uv = to_uv;
  texture.kind = BitmapTexture{std::move(bitmap), format, format == TexelFormat::kUnorm8Linear, wrap, filter};
  return texture;
}

std::vector<glm::vec4> random_points(float from, float to, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> u(from, to);
  std::vector<glm::vec4> points(kPoints);
  for (glm::vec4& p : points) p = {u(random), u(random), 0, 0};
  return points;
}

class TextureLookup : public DeviceTest {};

TEST_F(TextureLookup, BitmapsOfAllFormatsFiltersAndWraps) {
  Scene scene;
  const dmat3 turned = glm::transpose(dmat3(1.5, -0.7, 0.3, 0.4, 2.1, -0.2, 0, 0, 1));
  uint32_t seed = 1;
  for (const TexelFormat format :
       {TexelFormat::kUnorm8Srgb, TexelFormat::kUnorm8Linear, TexelFormat::kHalf, TexelFormat::kFloat})
    for (const int channels : {1, 3, 4}) {
      // A single-texel row or column, too.
      const auto bitmap = random_bitmap(channels == 4 ? 1 : 13, channels == 1 ? 5 : 32, channels, format, seed++);
      for (const WrapMode wrap : {WrapMode::kRepeat, WrapMode::kMirror, WrapMode::kClamp})
        for (const FilterType filter : {FilterType::kNearest, FilterType::kBilinear})
          scene.textures.push_back(bitmap_texture(bitmap, format, wrap, filter, seed % 2 == 0 ? turned : dmat3(1)));
    }
  const std::vector<glm::vec4> points = random_points(-4, 4, 99);
  int compared = 0;
  for (size_t t = 0; t < scene.textures.size(); ++t) {
    SCOPED_TRACE(fmt::format("texture {}", t));
    const ExactBitmap exact{scene.textures[t]};
    double largest = 0;
    for (int y = 0; y < exact.bitmap.bitmap->height; ++y)
      for (int x = 0; x < exact.bitmap.bitmap->width; ++x)
        for (int c = 0; c < 3; ++c) largest = std::max(largest, exact.texel(x, y)[c]);
    const std::vector<Lookup> results = look_up(scene, t, points);
    for (size_t i = 0; i < results.size(); ++i) {
      const dvec2 uv(points[i]);
      // uv' is known to 1e-6: that times the resolution is the uncertainty in texels.
      if (exact.to_edge(uv) < 1e-4) continue;
      ++compared;
      const dvec3 color = exact.color(uv);
      const bool nearest = exact.bitmap.filter == FilterType::kNearest;
      const double tolerance = (nearest ? 1.3e-6 : 4e-5) * largest;
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(double{results[i].color[c]}, color[c], tolerance) << uv.x << ' ' << uv.y;
      ASSERT_NEAR(double{results[i].color.w}, luminance(color), tolerance);
      const dvec2 gradient = exact.gradient(uv);
      const double slope = 5e-5 * largest * 150;
      ASSERT_NEAR(double{results[i].gradient.x}, gradient.x, slope) << uv.x << ' ' << uv.y;
      ASSERT_NEAR(double{results[i].gradient.y}, gradient.y, slope);
    }
  }
  EXPECT_GT(compared, 72 * kPoints * 0.99);
}

TEST_F(TextureLookup, DecodesEveryByteOfSrgb) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = 256;
  bitmap->height = 1;
  bitmap->channels = 1;
  for (int i = 0; i < 256; ++i) bitmap->bytes.push_back(static_cast<uint8_t>(i));
  Scene scene;
  scene.textures.push_back(
      bitmap_texture(bitmap, TexelFormat::kUnorm8Srgb, WrapMode::kClamp, FilterType::kNearest, dmat3(1)));
  std::vector<glm::vec4> points;
  for (int i = 0; i < 256; ++i) points.emplace_back((static_cast<float>(i) + 0.5f) / 256, 0.5f, 0, 0);
  const std::vector<Lookup> results = look_up(scene, 0, points);
  for (int i = 0; i < 256; ++i) {
    const double c = i / 255.0, exact = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(double{results[static_cast<size_t>(i)].color.x}, exact, 1.3e-6 * exact) << i;
  }
  EXPECT_EQ(results[0].color.x, 0.0f);
  EXPECT_NEAR(results[255].color.x, 1.0f, 1.2e-7f);
}

TEST_F(TextureLookup, UsesNoTexelBeyondTheImage) {
  // Coordinates at which rounding may reach the next texel, huge ones and ones that are no numbers.
  Scene scene;
  const auto bitmap = random_bitmap(7, 5, 3, TexelFormat::kFloat, 3);
  for (const WrapMode wrap : {WrapMode::kRepeat, WrapMode::kMirror, WrapMode::kClamp})
    for (const FilterType filter : {FilterType::kNearest, FilterType::kBilinear})
      scene.textures.push_back(bitmap_texture(bitmap, TexelFormat::kFloat, wrap, filter, dmat3(1)));
  double largest = 0, least = 1e30;
  for (float f : bitmap->floats) largest = std::max(largest, double{f}), least = std::min(least, double{f});
  std::vector<glm::vec4> points;
  for (const float u : {0.0f, 1.0f, -1.0f, 2.0f, 0.99999994f, 1.0000001f, -1e-9f, -1e-30f, 1e30f, -1e30f, 3.4e38f,
                        std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
    for (const float v : {0.0f, 1.0f, -1e-9f, 0.3f}) points.emplace_back(u, v, 0, 0);
  for (size_t t = 0; t < scene.textures.size(); ++t)
    for (const Lookup& lookup : look_up(scene, t, points))
      for (int c = 0; c < 3; ++c) {
        ASSERT_GE(lookup.color[c], least * (1 - 1e-6));
        ASSERT_LE(lookup.color[c], largest * (1 + 1e-6));
      }
}

TEST_F(TextureLookup, Checkerboard) {
  Scene scene;
  Texture texture;
  texture.to_uv = glm::transpose(dmat3(4, 0, 0.1, 0, 6, 0, 0, 0, 1));
  texture.kind = CheckerboardTexture{dvec3(0.1, 0.2, 0.6), dvec3(0.8, 0.7, 0.2)};
  scene.textures.push_back(texture);
  const std::vector<glm::vec4> points = random_points(-2, 2, 5);
  const std::vector<Lookup> results = look_up(scene, 0, points);
  for (size_t i = 0; i < results.size(); ++i) {
    const dvec2 q(texture.to_uv * dvec3(dvec2(points[i]), 1)), f = q - glm::floor(q);
    if (std::min({std::abs(f.x - 0.5), std::abs(f.y - 0.5), f.x, f.y, 1 - f.x, 1 - f.y}) < 1e-4) continue;
    // A scalar swaps the colours that a colour has: texture/checkerboard.glsl.
    const glm::vec3 color0(0.1f, 0.2f, 0.6f), color1(0.8f, 0.7f, 0.2f);
    const bool same = (f.x > 0.5) == (f.y > 0.5);
    ASSERT_EQ(glm::vec3(results[i].color), same ? color0 : color1) << q.x << ' ' << q.y;
    ASSERT_NEAR(double{results[i].color.w}, luminance(same ? color1 : color0), 1e-6);
    ASSERT_EQ(results[i].gradient, glm::vec2(0));
  }
}

/// Squares that are textures: bitmaps, a mesh attribute, checkerboards down to the last that may be.
TEST_F(TextureLookup, CheckerboardsOfTextures) {
  Scene scene;
  const dmat3 outer = glm::transpose(dmat3(3, 1, 0.1, -0.4, 2, 0.3, 0, 0, 1));
  const dmat3 inner = glm::transpose(dmat3(1.5, -0.7, 0.3, 0.4, 2.1, -0.2, 0, 0, 1));
  const auto image = random_bitmap(6, 5, 3, TexelFormat::kUnorm8Srgb, 11);
  const auto add = [&](Texture texture) {
    scene.textures.push_back(std::move(texture));
    ColorInput input;
    input.texture = static_cast<TextureIndex>(scene.textures.size()) - 1;
    return input;
  };
  const auto board = [&](const dmat3& to_uv, const ColorInput& color0, const ColorInput& color1) {
    return add({{}, to_uv, CheckerboardTexture{color0, color1}});
  };
  const ColorInput bitmap = add(
      bitmap_texture(image, TexelFormat::kUnorm8Srgb, WrapMode::kMirror, FilterType::kBilinear, inner));
  const ColorInput red = dvec3(0.8, 0.2, 0.1), blue = dvec3(0.1, 0.2, 0.9);
  const ColorInput second = board(inner, red, bitmap), third = board(dmat3(1), second, blue);
  const ColorInput boards[] = {board(outer, bitmap, red), third, board(outer, third, second)};
  ASSERT_EQ(gpu::kMostCheckerboards, 4u);
  const ColorInput deepest = board(glm::transpose(dmat3(0.3, 0, 0, 0, 0.4, 0, 0, 0, 1)), red, boards[2]);

  // What a point sees, by scene-format's words; none where it is too near to the edge of a square.
  const auto seen = [&](ColorInput input, const dvec2& uv, bool scalar) -> std::optional<ColorInput> {
    while (input.texture != kNone) {
      const Texture& texture = scene.textures[static_cast<size_t>(input.texture)];
      const auto* squares = std::get_if<CheckerboardTexture>(&texture.kind);
      if (!squares) return input;
      const dvec2 q(texture.to_uv * dvec3(uv, 1)), f = q - glm::floor(q);
      if (std::min({std::abs(f.x - 0.5), std::abs(f.y - 0.5), f.x, f.y, 1 - f.x, 1 - f.y}) < 1e-4) return {};
      input = ((f.x > 0.5) == (f.y > 0.5)) != scalar ? squares->color0 : squares->color1;
    }
    return input;
  };
  const ExactBitmap exact{scene.textures[static_cast<size_t>(bitmap.texture)]};
  const std::vector<glm::vec4> points = random_points(-2, 2, 5);
  for (const ColorInput& outermost : {boards[0], boards[1], boards[2], deepest}) {
    SCOPED_TRACE(fmt::format("texture {}", outermost.texture));
    const std::vector<Lookup> results = look_up(scene, static_cast<size_t>(outermost.texture), points);
    int compared = 0, bitmaps = 0;
    for (size_t i = 0; i < results.size(); ++i) {
      const dvec2 uv(points[i]);
      const auto color = seen(outermost, uv, false), scalar = seen(outermost, uv, true);
      if (!color || !scalar || exact.to_edge(uv) < 1e-4) continue;
      ++compared;
      bitmaps += color->texture != kNone && scalar->texture == kNone;
      const dvec3 c = color->texture == kNone ? color->value : exact.color(uv);
      const dvec3 s = scalar->texture == kNone ? scalar->value : exact.color(uv);
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(double{results[i].color[k]}, c[k], 4e-5) << uv.x << ' ' << uv.y;
      ASSERT_NEAR(double{results[i].color.w}, luminance(s), 4e-5) << uv.x << ' ' << uv.y;
      const dvec2 g = scalar->texture == kNone ? dvec2(0) : exact.gradient(uv);
      ASSERT_NEAR(double{results[i].gradient.x}, g.x, 2e-3) << uv.x << ' ' << uv.y;
      ASSERT_NEAR(double{results[i].gradient.y}, g.y, 2e-3);
    }
    EXPECT_GT(compared, kPoints * 0.98);
    EXPECT_GT(bitmaps, kPoints / 20);
  }
}

TEST_F(TextureLookup, CheckerboardOfConstantBitmapsIsOneOfColors) {
  Scene scene;
  const dmat3 to_uv = glm::transpose(dmat3(4, 0.3, 0.1, -0.2, 6, 0, 0, 0, 1));
  const dvec3 colors[] = {{0.125, 0.25, 0.625}, {0.75, 0.5, 0.375}};
  CheckerboardTexture of_bitmaps;
  for (const int i : {0, 1}) {
    auto bitmap = std::make_shared<Bitmap>();
    bitmap->width = 3;
    bitmap->height = 2;
    bitmap->channels = 3;
    for (int t = 0; t < 6; ++t)
      for (int c = 0; c < 3; ++c) bitmap->floats.push_back(static_cast<float>(colors[i][c]));
    scene.textures.push_back(bitmap_texture(bitmap, TexelFormat::kFloat, WrapMode::kRepeat, FilterType::kBilinear,
                                            glm::transpose(dmat3(7, 1, 2, 3, 5, 4, 0, 0, 1))));
    (i == 0 ? of_bitmaps.color0 : of_bitmaps.color1).texture = i;
  }
  scene.textures.push_back({{}, to_uv, of_bitmaps});
  scene.textures.push_back({{}, to_uv, CheckerboardTexture{colors[0], colors[1]}});
  const std::vector<glm::vec4> points = random_points(-2, 2, 6);
  const std::vector<Lookup> nested = look_up(scene, 2, points), plain = look_up(scene, 3, points);
  for (size_t i = 0; i < points.size(); ++i) {
    ASSERT_LT(glm::length(nested[i].color - plain[i].color), 1e-6f) << points[i].x << ' ' << points[i].y;
    ASSERT_EQ(nested[i].gradient, plain[i].gradient);
  }
}

TEST_F(TextureLookup, MeshAttributes) {
  Scene scene;
  const auto mesh = [](bool with) {
    auto m = std::make_shared<Mesh>();
    m->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    m->triangles = {{0, 1, 2}, {2, 1, 3}};
    if (with) {
      m->attributes.push_back({"vertex_color", 3, {0, 0, 1, 1, 0, 0, 0, 1, 0, 0.5f, 0.25f, 4}});
      m->attributes.push_back({"face_weight", 1, {2, 7}});
    }
    return m;
  };
  for (const bool with : {false, true, false}) {
    Shape shape;
    shape.kind = MeshShape{mesh(with)};
    scene.shapes.push_back(shape);
  }
  for (const char* name : {"vertex_color", "face_weight"}) {
    Texture texture;
    texture.kind = MeshAttributeTexture{name, 2};
    scene.textures.push_back(texture);
  }
  CheckerboardTexture board;  // every point below is in one of its squares
  board.color0.texture = board.color1.texture = 0;
  scene.textures.push_back({{}, dmat3(1), board});
  std::vector<glm::vec4> points;
  for (uint32_t triangle : {0u, 2u, 3u, 5u}) points.emplace_back(0.25f, 0.5f, std::bit_cast<float>(triangle), 0);
  const std::vector<Lookup> color = look_up(scene, 0, points), weight = look_up(scene, 1, points),
                            checkered = look_up(scene, 2, points);
  // 2 (0.25 v0 + 0.25 v1 + 0.5 v2)
  const glm::vec3 expected[] = {{0, 0, 0}, {0.5f, 1, 0.5f}, {1.0f, 0.75f, 4}, {0, 0, 0}};
  const float weights[] = {0, 4, 14, 0};
  for (size_t i = 0; i < points.size(); ++i) {
    const glm::vec3 e = i == 2 ? glm::vec3(2 * (0.25f * 0 + 0.25f * 1 + 0.5f * 0.5f), 2 * (0.25f * 1 + 0.5f * 0.25f), 4)
                               : expected[i];
    EXPECT_LT(glm::length(glm::vec3(color[i].color) - e), 1e-6f) << i;
    EXPECT_EQ(checkered[i].color, color[i].color) << i;
    EXPECT_EQ(glm::vec3(weight[i].color), glm::vec3(weights[i])) << i;
  }
}

}  // namespace
}  // namespace tachylite
