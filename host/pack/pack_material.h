#pragma once

#include <cstdint>
#include <span>
#include <string>
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
/// Throws InputError for more than kMaterialMaxLeaves bsdfs in one blend, more than kMostFrames maps inside one another
/// and more than kMaxClasses classes.
PackedMaterials pack_materials(const Scene& scene, std::span<const uint32_t> row_of_texture);

/// What the name of a kernel that shades surfaces ends with in the variant for that class (cmake/BsdfVariants.cmake):
/// "_diffuse", "_principled_textured", "_mixture" ...
std::string bsdf_kernel_variant(const MaterialClass& material_class);

}  // namespace tachylite
