#include "pack/pack_texture.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <glm/gtc/packing.hpp>

#include "base/error.h"
#include "pack/float_bits.h"
#include "shared/texture.h"

namespace tachylite {
namespace {

bool is_bytes(TexelFormat format) {
  return format == TexelFormat::kUnorm8Srgb || format == TexelFormat::kUnorm8Linear;
}

/// Channel c of a texel as stored; grey is repeated, alpha (of grey or colour) left out.
size_t channel_index(const Bitmap& bitmap, size_t texel, size_t c) {
  const auto channels = static_cast<size_t>(bitmap.channels);
  return texel * channels + (channels >= 3 ? c : 0);
}

struct TexturePacker {
  const Scene& scene;
  const Geometry& geometry;
  PackedTextures out;
  std::map<std::pair<const Bitmap*, int>, uint32_t> first_texel_of;  // by bitmap and buffer
  std::map<std::string, glm::uvec4> attribute_of;                    // row 0 by name

  /// First texel of a bitmap in the buffer of its format: 0 = bytes, 1 = half, 2 = float.
  uint32_t put_texels(const Bitmap& bitmap, TexelFormat format) {
    const int buffer = is_bytes(format) ? 0 : (format == TexelFormat::kHalf ? 1 : 2);
    const auto [found, is_new] = first_texel_of.try_emplace({&bitmap, buffer}, 0u);
    if (!is_new) return found->second;
    const size_t count = static_cast<size_t>(bitmap.width) * static_cast<size_t>(bitmap.height);
    const auto value = [&](size_t i, size_t c) { return bitmap.floats[channel_index(bitmap, i, c)]; };
    if (buffer == 0) {
      found->second = static_cast<uint32_t>(out.texels8.size());
      out.texels8.reserve(out.texels8.size() + count);
      const auto byte = [&](size_t i, size_t c) { return uint32_t{bitmap.bytes[channel_index(bitmap, i, c)]}; };
      for (size_t i = 0; i < count; ++i)
        out.texels8.push_back(byte(i, 0) | byte(i, 1) << 8 | byte(i, 2) << 16 | 0xffu << 24);
    } else if (buffer == 1) {
      found->second = static_cast<uint32_t>(out.texels16.size());
      for (size_t i = 0; i < count; ++i)
        out.texels16.emplace_back(glm::packHalf2x16({value(i, 0), value(i, 1)}), glm::packHalf2x16({value(i, 2), 1}));
    } else {
      found->second = static_cast<uint32_t>(out.texels32.size());
      for (size_t i = 0; i < count; ++i) out.texels32.emplace_back(value(i, 0), value(i, 1), value(i, 2), 1.0f);
    }
    return found->second;
  }

  glm::uvec4 row0(const Texture&, const BitmapTexture& texture) {
    const Bitmap& bitmap = *texture.bitmap;
    const auto format = static_cast<uint32_t>(texture.format);
    const bool nearest = texture.filter == FilterType::kNearest;
    const uint32_t wrap = texture.wrap == WrapMode::kRepeat   ? gpu::kWrapRepeat
                          : texture.wrap == WrapMode::kMirror ? gpu::kWrapMirror
                                                              : gpu::kWrapClamp;
    out.kinds |= gpu::kTexturesBitmap | gpu::kTextures8Srgb << format | gpu::kTexturesRepeat << wrap |
                 (nearest ? gpu::kTexturesNearest : gpu::kTexturesBilinear);
    return {gpu::kTextureBitmap | format << gpu::kTextureFormatShift |
                (nearest ? gpu::kFilterNearest : gpu::kFilterBilinear) << gpu::kTextureFilterShift |
                wrap << gpu::kTextureWrapShift | static_cast<uint32_t>(bitmap.channels) << gpu::kTextureChannelShift,
            put_texels(bitmap, texture.format), static_cast<uint32_t>(bitmap.width),
            static_cast<uint32_t>(bitmap.height)};
  }

  glm::uvec4 row0(const Texture&, const CheckerboardTexture&) {
    out.kinds |= gpu::kTexturesCheckerboard;
    return {gpu::kTextureCheckerboard, 0, 0, 0};
  }

  glm::uvec4 square(const ColorInput& color) {
    if (color.texture == kNone) return {bits(color.value.r), bits(color.value.g), bits(color.value.b), 0};
    static_assert(gpu::kMostCheckerboards == kMostCheckerboards);
    out.kinds |= gpu::kTexturesNested;
    return {0, 0, 0, 1 + static_cast<uint32_t>(color.texture) * gpu::kTextureRows};
  }

  glm::uvec4 row0(const Texture& texture, const MeshAttributeTexture& attribute) {
    out.kinds |= gpu::kTexturesAttribute;
    const auto [found, is_new] = attribute_of.try_emplace(attribute.name, 0u);
    if (is_new) found->second = put_attribute(texture, attribute.name);
    return found->second;
  }

  static const MeshAttribute* find_attribute(const Shape& shape, const std::string& name) {
    const auto* mesh = std::get_if<MeshShape>(&shape.kind);
    if (!mesh) return nullptr;
    const auto& all = mesh->mesh->attributes;
    const auto found = std::find_if(all.begin(), all.end(), [&](const MeshAttribute& a) { return a.name == name; });
    return found == all.end() ? nullptr : &*found;
  }

  glm::uvec4 put_attribute(const Texture& texture, const std::string& name) {
    const bool per_vertex = name.starts_with("vertex_");
    uint32_t first = 0xffffffffu, last = 0;
    for (size_t s = 0; s < scene.shapes.size(); ++s) {
      if (!find_attribute(scene.shapes[s], name)) continue;
      const ShapeGeometry& range = geometry.shapes[s];
      first = std::min(first, range.first_primitive);
      last = std::max(last, range.first_primitive + range.primitive_count);
    }
    if (first >= last) throw InputError(texture.where, fmt::format("no mesh has the attribute '{}'", name));
    const uint32_t rows_each = per_vertex ? 3 : 1, base = static_cast<uint32_t>(out.attributes.size());
    out.attributes.resize(out.attributes.size() + size_t{rows_each} * (last - first), glm::vec4(0));
    for (size_t s = 0; s < scene.shapes.size(); ++s) {
      const MeshAttribute* attribute = find_attribute(scene.shapes[s], name);
      if (!attribute) continue;
      if (attribute->channels != 1 && attribute->channels != 3)
        throw InputError(scene.shapes[s].where, fmt::format("mesh attribute '{}' has {} channels; 1 or 3 were expected",
                                                            name, attribute->channels));
      const auto value = [&](size_t i) {
        const auto channels = static_cast<size_t>(attribute->channels);
        const float* v = &attribute->values[i * channels];
        return channels == 1 ? glm::vec4(v[0], v[0], v[0], 0) : glm::vec4(v[0], v[1], v[2], 0);
      };
      const Mesh& mesh = *std::get<MeshShape>(scene.shapes[s].kind).mesh;
      glm::vec4* rows = &out.attributes[base + size_t{rows_each} * (geometry.shapes[s].first_primitive - first)];
      for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (uint32_t k = 0; k < rows_each; ++k)
          rows[t * rows_each + k] = value(per_vertex ? mesh.triangles[t][static_cast<int>(k)] : t);
    }
    return {gpu::kTextureAttribute | (per_vertex ? gpu::kAttributePerVertex : 0u), base, first, last - first};
  }

  void put(const Texture& texture) {
    out.row_of_texture.push_back(static_cast<uint32_t>(out.rows.size()));
    const glm::uvec4 head = std::visit([&](const auto& kind) { return row0(texture, kind); }, texture.kind);
    const dmat3& m = texture.to_uv;  // columns
    std::vector<glm::uvec4> rows = {head,
                                    {bits(m[0][0]), bits(m[1][0]), bits(m[2][0]), 0},
                                    {bits(m[0][1]), bits(m[1][1]), bits(m[2][1]), 0},
                                    glm::uvec4(0),
                                    glm::uvec4(0)};
    if (const auto* board = std::get_if<CheckerboardTexture>(&texture.kind)) {
      rows[3] = square(board->color0);
      rows[4] = square(board->color1);
    } else if (const auto* attribute = std::get_if<MeshAttributeTexture>(&texture.kind)) {
      rows[3].x = bits(attribute->scale);
    }
    if (m != dmat3(1) && !std::holds_alternative<MeshAttributeTexture>(texture.kind))
      out.kinds |= gpu::kTexturesTransform;
    static_assert(gpu::kTextureRows == 5);
    out.rows.insert(out.rows.end(), rows.begin(), rows.end());
  }
};

double folded(double u, WrapMode wrap) {
  if (wrap == WrapMode::kClamp) return std::clamp(u, 0.0, 1.0);
  if (wrap == WrapMode::kRepeat) return u - std::floor(u);
  const double m = u - 2 * std::floor(u / 2);
  return m > 1 ? 2 - m : m;
}

/// Mesh attributes count as 1.
dvec3 point_color(const Scene& scene, const Texture& texture, const dvec2& uv) {
  if (std::holds_alternative<MeshAttributeTexture>(texture.kind)) return dvec3(1);
  const dvec2 q(texture.to_uv * dvec3(uv, 1));
  if (const auto* board = std::get_if<CheckerboardTexture>(&texture.kind)) {
    const bool same = (q.x - std::floor(q.x) > 0.5) == (q.y - std::floor(q.y) > 0.5);
    const ColorInput& color = same ? board->color0 : board->color1;
    return color.texture == kNone ? color.value
                                  : point_color(scene, scene.textures[static_cast<size_t>(color.texture)], uv);
  }
  const auto& bitmap = std::get<BitmapTexture>(texture.kind);
  const int width = bitmap.bitmap->width, height = bitmap.bitmap->height;
  const int x = std::min(static_cast<int>(folded(q.x, bitmap.wrap) * width), width - 1);
  const int y = std::min(static_cast<int>(folded(q.y, bitmap.wrap) * height), height - 1);
  return glm::max(texel_color(*bitmap.bitmap, bitmap.format, x, y), dvec3(0));
}

}  // namespace

double decode_srgb(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

dvec3 texel_color(const Bitmap& bitmap, TexelFormat format, int x, int y) {
  const size_t texel = static_cast<size_t>(y) * static_cast<size_t>(bitmap.width) + static_cast<size_t>(x);
  dvec3 color;
  for (size_t c = 0; c < 3; ++c) {
    const size_t i = channel_index(bitmap, texel, c);
    const int k = static_cast<int>(c);
    if (!is_bytes(format))
      color[k] = double{bitmap.floats[i]};
    else
      color[k] = format == TexelFormat::kUnorm8Srgb ? decode_srgb(bitmap.bytes[i] / 255.0) : bitmap.bytes[i] / 255.0;
  }
  return color;
}

bool reads_mesh_attribute(const Scene& scene, const Texture& texture) {
  const auto inside = [&](const ColorInput& color) {
    return color.texture != kNone && reads_mesh_attribute(scene, scene.textures[static_cast<size_t>(color.texture)]);
  };
  if (const auto* board = std::get_if<CheckerboardTexture>(&texture.kind))
    return inside(board->color0) || inside(board->color1);
  return std::holds_alternative<MeshAttributeTexture>(texture.kind);
}

dvec3 mean_texture_color(const Scene& scene, const Texture& texture) {
  if (const auto* board = std::get_if<CheckerboardTexture>(&texture.kind)) {
    dvec3 sum(0);
    for (const ColorInput* color : {&board->color0, &board->color1})
      sum += color->texture == kNone ? color->value
                                     : mean_texture_color(scene, scene.textures[static_cast<size_t>(color->texture)]);
    return 0.5 * sum;
  }
  const auto* bitmap_texture = std::get_if<BitmapTexture>(&texture.kind);
  if (!bitmap_texture) return dvec3(1);
  const Bitmap& bitmap = *bitmap_texture->bitmap;
  const int step_x = std::max(1, bitmap.width / 64), step_y = std::max(1, bitmap.height / 64);
  dvec3 sum(0);
  double count = 0;
  for (int y = step_y / 2; y < bitmap.height; y += step_y)
    for (int x = step_x / 2; x < bitmap.width; x += step_x, ++count)
      sum += glm::max(texel_color(bitmap, bitmap_texture->format, x, y), dvec3(0));
  return sum / count;
}

dvec3 mean_texture_color(const Scene& scene, const Texture& texture, const dvec2& corner, const dvec2& a,
                         const dvec2& b, bool parallelogram) {
  constexpr int kPoints = 6;  // along each side
  dvec3 sum(0);
  for (int i = 0; i < kPoints; ++i)
    for (int j = 0; j < kPoints; ++j) {
      double s = (i + 0.5) / kPoints, t = (j + 0.5) / kPoints;
      if (!parallelogram && s + t > 1) s = 1 - s, t = 1 - t;
      sum += point_color(scene, texture, corner + s * a + t * b);
    }
  return sum / double(kPoints * kPoints);
}

PackedTextures pack_textures(const Scene& scene, const Geometry& geometry) {
  TexturePacker packer{scene, geometry, {}, {}, {}};
  for (const Texture& texture : scene.textures) packer.put(texture);
  return std::move(packer.out);
}

}  // namespace tachylite
