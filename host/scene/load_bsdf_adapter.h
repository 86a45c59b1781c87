#pragma once

#include "scene/plugin.h"

namespace tachylite {

/// Bsdfs other than adapters that `kind` holds, counted as often as it refers to them.
size_t count_leaves(const Scene& scene, const BsdfKind& kind);

// Bsdfs around other bsdfs.
BsdfKind load_twosided(const Plugin& plugin);
BsdfKind load_mask(const Plugin& plugin);
BsdfKind load_blend(const Plugin& plugin);
BsdfKind load_normal_map(const Plugin& plugin);
BsdfKind load_bump_map(const Plugin& plugin);

/// Whether light can pass to the other side.
bool transmits(const Scene& scene, BsdfIndex index);

}  // namespace tachylite
