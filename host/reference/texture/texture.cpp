#include "reference/texture/texture.h"

#include "reference/texture/bitmap.h"
#include "reference/texture/checkerboard.h"

namespace tachylite::reference {
namespace {

dvec3 eval_kind(const BitmapTexture& texture, const dvec2& uv, const TextureCoordinates&) {
  return eval_bitmap(texture, uv);
}
dvec3 eval_kind(const CheckerboardTexture& texture, const dvec2& uv, const TextureCoordinates&) {
  return eval_checkerboard(texture, uv);
}

/// vertex_NAME is interpolated with the barycentrics, face_NAME is constant on a triangle; 0 where the mesh
/// has none.
dvec3 eval_kind(const MeshAttributeTexture& texture, const dvec2&, const TextureCoordinates& at) {
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
  const dvec2 uv = dvec2(texture.to_uv * dvec3(at.uv, 1));
  return std::visit([&](const auto& kind) { return eval_kind(kind, uv, at); }, texture.kind);
}

dvec2 eval_texture_gradient(const Scene& scene, TextureIndex index, const TextureCoordinates& at) {
  const Texture& texture = scene.textures[static_cast<size_t>(index)];
  const auto* bitmap = std::get_if<BitmapTexture>(&texture.kind);
  if (!bitmap) return dvec2(0);
  const dvec2 gradient = eval_bitmap_gradient(*bitmap, dvec2(texture.to_uv * dvec3(at.uv, 1)));
  return glm::transpose(glm::dmat2(texture.to_uv)) * gradient;
}

dvec3 eval_color(const Scene& scene, const ColorInput& input, const TextureCoordinates& at) {
  return input.texture == kNone ? input.value : eval_texture(scene, input.texture, at);
}

double eval_scalar(const Scene& scene, const ScalarInput& input, const TextureCoordinates& at) {
  if (input.texture == kNone) return input.value;
  const Texture& texture = scene.textures[static_cast<size_t>(input.texture)];
  if (const auto* checkerboard = std::get_if<CheckerboardTexture>(&texture.kind)) {
    return eval_checkerboard_scalar(*checkerboard, dvec2(texture.to_uv * dvec3(at.uv, 1)));
  }
  return luminance(eval_texture(scene, input.texture, at));
}

}  // namespace tachylite::reference
