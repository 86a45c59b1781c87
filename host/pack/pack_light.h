#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "accel/bvh.h"
#include "base/bulk_vector.h"
#include "pack/pack_geometry.h"
#include "pack/pack_texture.h"
#include "scene/scene.h"

namespace tachylite {

/// The lights of a scene as records of shared/light.h.
struct PackedLights {
  std::vector<glm::vec4> rows;             // kBindLights
  std::vector<glm::uvec4> table;           // kBindLightTable; a header at least, also in a scene without lights
  PageVector<glm::vec4> environment;       // kBindEnvironment
  PageVector<glm::vec4> environment_cdf;   // kBindEnvironmentCdf
  std::vector<uint32_t> light_of_shape;    // first light row of each shape; kNoIndex: it does not emit
  std::vector<float> emission;             // kBindEmission: for each record of an area light, the share of all their
                                           // power that it and those before it have; empty: there are none
  uint32_t kinds = 0;                      // set of 1 << kLight... and kLights...
  uint32_t selection = 0;                  // kSelect...
  bool textures = false;                   // some radiance is a texture
  uint32_t environment_row = 0xffffffffu;  // first row of the environment's record; kNoIndex: there is none
  uint32_t count = 0;                      // of lights that are sampled
};

/// bvh: of the geometry, for the hits that shadow rays ignore. textures: of the scene.
/// Throws InputError for emitters that the device cannot render: on a sphere that is scaled unevenly, an environment
/// map with values that are not finite or whose transform is no rotation.
PackedLights pack_lights(const Scene& scene, const Geometry& geometry, const Bvh8& bvh,
                         const PackedTextures& textures);

}  // namespace tachylite
