#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "pack/feature_set.h"
#include "scene/scene.h"

namespace tachylite {

/// The materials of a scene's shapes as rows of shared/material.h.
struct PackedMaterials {
  std::vector<glm::uvec4> rows;
  std::vector<MaterialClass> classes;     // each differs from the others
  std::vector<uint32_t> row_of_bsdf;      // for each of Scene::bsdfs: its row; kNoIndex where no shape has it
  std::vector<uint32_t> class_of_bsdf;    // index into classes; kClassNone: absorbs everything (or no shape has it)
};

/// row_of_texture: for each of Scene::textures, its row in kBindTextures.
/// Throws InputError for what Mitsuba refuses too (a transmitting child of `twosided`), and for more than
/// kMaterialMaxLeaves bsdfs in one blend.
PackedMaterials pack_materials(const Scene& scene, std::span<const uint32_t> row_of_texture);

}  // namespace tachylite
