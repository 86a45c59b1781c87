#include "reference/texture/texture.h"

#include "reference/texture/bitmap.h"
#include "reference/texture/checkerboard.h"

namespace tachylite::reference {
namespace {

/// Through to_uv.
dvec2 own_uv(const Texture& texture, const TextureCoordinates& at) {
  return dvec2(texture.to_uv * dvec3(at.uv, 1));
}

dvec3 eval_kind(const Scene&, const BitmapTexture& texture, const dvec2& uv, const TextureCoordinates&) {
  return eval_bitmap(texture, uv);
}
dvec3 eval_kind(const Scene& scene, const CheckerboardTexture& texture, const dvec2& uv,
                const TextureCoordinates& at) {
  return eval_color(scene, square_as_color(texture, uv), at);
}

/// vertex_NAME is interpolated with the barycentrics, face_NAME is constant on a triangle; 0 where the mesh
/// has none.
dvec3 eval_kind(const Scene&, const MeshAttributeTexture& texture, const dvec2&, const TextureCoordinates& at) {
  if (!at.mesh) return dvec3(0);
  for (const MeshAttribute& attribute : at.mesh->attributes) {
    if (attribute.name != texture.name) continue;
    const bool per_face = texture.name.starts_with("face_");
    auto value = [&](size_t item, int channel) {
      const int c = std::min(channel, attribute.channels - 1);
      return double{
          attribute.values[item * static_cast<size_t>(attribute.channels) + static_cast<size_t>(c)]};
    };
    dvec3 result(0);
    for (int c = 0; c < 3; ++c) {
      if (per_face) {
        result[c] = value(at.triangle, c);
      } else {
        const glm::uvec3 vertices = at.mesh->triangles[at.triangle];
        for (int k = 0; k < 3; ++k) result[c] += at.barycentrics[k] * value(vertices[k], c);
      }
    }
    return result * texture.scale;
  }
  return dvec3(0);
}

}  // namespace

dvec3 eval_texture(const Scene& scene, TextureIndex index, const TextureCoordinates& at) {
  const Texture& texture = scene.textures[static_cast<size_t>(index)];
  const dvec2 uv = own_uv(texture, at);
  return std::visit([&](const auto& kind) { return eval_kind(scene, kind, uv, at); }, texture.kind);
}

dvec2 eval_texture_gradient(const Scene& scene, TextureIndex index, const TextureCoordinates& at) {
  const Texture& texture = scene.textures[static_cast<size_t>(index)];
  const dvec2 uv = own_uv(texture, at);
  if (const auto* checkerboard = std::get_if<CheckerboardTexture>(&texture.kind)) {
    const TextureIndex inside = square_as_scalar(*checkerboard, uv).texture;
    return inside == kNone ? dvec2(0) : eval_texture_gradient(scene, inside, at);
  }
  const auto* bitmap = std::get_if<BitmapTexture>(&texture.kind);
  if (!bitmap) return dvec2(0);
  return glm::transpose(glm::dmat2(texture.to_uv)) * eval_bitmap_gradient(*bitmap, uv);
}

dvec3 eval_color(const Scene& scene, const ColorInput& input, const TextureCoordinates& at) {
  return input.texture == kNone ? input.value : eval_texture(scene, input.texture, at);
}

double eval_scalar(const Scene& scene, const ScalarInput& input, const TextureCoordinates& at) {
  if (input.texture == kNone) return input.value;
  const Texture& texture = scene.textures[static_cast<size_t>(input.texture)];
  if (const auto* checkerboard = std::get_if<CheckerboardTexture>(&texture.kind)) {
    const ColorInput& square = square_as_scalar(*checkerboard, own_uv(texture, at));
    ScalarInput inside(luminance(square.value));
    inside.texture = square.texture;
    return eval_scalar(scene, inside, at);
  }
  return luminance(eval_texture(scene, input.texture, at));
}

}  // namespace tachylite::reference
