#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "pack/feature_set.h"
#include "pack/pack_geometry.h"
#include "shared/guide.h"
#include "shared/material.h"

namespace tachylite {

/// Whether surfaces of the class may throw light together.
constexpr bool can_focus(const MaterialClass& c) {
  return (c.bsdfs & (1u << gpu::kBsdfConductor | 1u << gpu::kBsdfRoughConductor | 1u << gpu::kBsdfDielectric |
                     1u << gpu::kBsdfRoughDielectric)) != 0;
}

/// Spheres (centre, radius; device space) around shapes that can_focus(), at most kMaxFocusers: those that are nearest
/// to each other share one. Shapes that nearly fill the scene are left out, and all but the largest of very many.
/// class_of_shape: index into `classes`, or kClassNone.
std::vector<glm::vec4> find_focusers(const Geometry& geometry, const std::vector<uint32_t>& class_of_shape,
                                     const std::vector<MaterialClass>& classes);

}  // namespace tachylite
