#pragma once

// Light records of the primitives of one emitting shape; used by pack_light.

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "pack/light_tree.h"
#include "pack/pack_geometry.h"
#include "scene/scene.h"
#include "shared/light.h"

namespace tachylite {

/// One record: its rows but for those words that pack_light fills (trail, row of the corners), and what selecting it
/// needs.
struct LightRecord {
  uint32_t kind = 0, flags = 0;
  glm::vec4 rows[gpu::kLightRows] = {};
  LightBounds bounds;                   // power 0: never sampled
  bool infinite = false;
  std::vector<glm::vec4> corners;       // rows of the corners' data; empty: none
};

/// What the radiance of an area light is.
struct LightRadiance {
  dvec3 value{0};                       // constant, or the mean of the texture
  const Texture* texture = nullptr;
  uint32_t texture_row = 0;             // kNoTexture for a constant
};

/// Records of shape `s` in order of its primitives, one for each triangle (or two, with kLightPairs) or one for a
/// curved shape. emitters: how many of the scene's are sampled. hits: for each primitive of the shape, 2 * leaf +
/// triangle or kNoHit.
std::vector<LightRecord> area_light_records(const Scene& scene, const Geometry& geometry, size_t s,
                                            const LightRadiance& radiance, size_t emitters,
                                            const std::vector<uint32_t>& hits);

inline double mean_component(const dvec3& c) { return (c.x + c.y + c.z) / 3; }

}  // namespace tachylite
