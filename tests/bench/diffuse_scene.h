#pragma once

#include "bench/scenes.h"
#include "pack/bake_geometry.h"
#include "scene/scene.h"

namespace tachylite::bench {

/// The bench scene to be rendered: its surfaces diffuse and two-sided, its light an area light; no roulette.
Scene diffuse_scene(const BenchScene& scene, uint32_t max_depth);
/// The primitives of one of tiny_scene_names(). Throws std::invalid_argument for another scene.
BakedGeometry bake_scene(const BenchScene& scene);

}  // namespace tachylite::bench
