#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "pack/pack_scene.h"
#include "wavefront/renderer.h"

namespace tachylite {

/// Whether directions on diffuse surfaces of the class may be guided (shaders/path/guide.glsl).
bool can_be_guided(const MaterialClass& material_class);

/// Whether photons are traced: they are to tell all light but that which light samples find, so that all lights must
/// have areas; there are no media; and something must throw light together that can_be_guided() surfaces may catch.
bool may_be_guided(const PackedScene& scene, Guiding guiding);

/// Bounces of a photon at most.
constexpr uint32_t kPhotonBounces = 16;

/// Photons to learn from: a function of the film's width alone, so that neither samples nor crop change the guide.
uint32_t photon_count(const gpu::RenderParams& params);

/// The largest edge of a guide's cell by its distance from the camera (of orthographic cameras the edge).
float guide_scale(const gpu::RenderParams& params);

/// Whether guiding by that flux pays: at least kCausticShare of it came straight from focused lobes (`caustics`, the
/// counter kCounterCaustics), where chance finds it rarely.
constexpr double kCausticShare = 0.01;
bool guide_pays(std::span<const uint32_t> flux, uint32_t caustics);

/// Writes kBindGuide of shared/guide.h from what photons have left in kBindPhotons: a mixture of their distribution and of
/// the uniform one, which has the more weight the fewer photons there are. Each cell has 1 + focusers tables; `guide` has
/// one cell more than `flux`. What no sample reads is not written.
void build_guide(std::span<const uint32_t> flux, uint32_t focusers, std::span<glm::uvec2> guide);

}  // namespace tachylite
