#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "base/bulk_vector.h"
#include "pack/pack_geometry.h"
#include "scene/scene.h"

namespace tachylite {

/// The textures of a scene as rows of shared/texture.h, with their texels. Textures that name the same file share
/// its texels.
struct PackedTextures {
  std::vector<glm::uvec4> rows;           // kBindTextures
  PageVector<uint32_t> texels8;           // RGBA8
  PageVector<glm::uvec2> texels16;        // RGBA16F
  PageVector<glm::vec4> texels32;         // RGBA32F
  PageVector<glm::vec4> attributes;       // kBindAttributes
  std::vector<uint32_t> row_of_texture;   // for each of Scene::textures
  uint32_t kinds = 0;                     // set of kTextures...
};

/// Throws InputError for a mesh attribute that no mesh has, and for one that is neither grey nor a colour.
PackedTextures pack_textures(const Scene& scene, const Geometry& geometry);

/// IEC 61966-2-1, c in [0, 1].
double decode_srgb(double c);

/// Linear colour of texel (x, y) of a bitmap: grey repeated, 8-bit values decoded as the format says.
dvec3 texel_color(const Bitmap& bitmap, TexelFormat format, int x, int y);

/// Whether it is a mesh attribute, or a checkerboard that has one in it.
bool reads_mesh_attribute(const Scene& scene, const Texture& texture);

/// Mean of a texture, estimated from at most some 64 x 64 texels. Mesh attributes count as 1.
dvec3 mean_texture_color(const Scene& scene, const Texture& texture);
/// The same over a part of the uv plane, from 36 points: the triangle or parallelogram (corner, corner + a,
/// corner + b).
dvec3 mean_texture_color(const Scene& scene, const Texture& texture, const dvec2& corner, const dvec2& a,
                         const dvec2& b, bool parallelogram);

}  // namespace tachylite
