#pragma once

#include "scene/plugin.h"

namespace tachylite {

// Bsdfs around other bsdfs, and the null bsdf.
/// Bsdfs other than adapters that `kind` holds, counted as often as it refers to them.
size_t count_leaves(const Scene& scene, const BsdfKind& kind);

BsdfKind load_twosided(const Plugin& plugin);
BsdfKind load_mask(const Plugin& plugin);
BsdfKind load_blend(const Plugin& plugin);
BsdfKind load_normal_map(const Plugin& plugin);
BsdfKind load_bump_map(const Plugin& plugin);

}  // namespace tachylite
