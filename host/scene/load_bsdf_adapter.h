#pragma once

#include "scene/plugin.h"

namespace tachylite {

// Bsdfs around other bsdfs, and the null bsdf.
BsdfKind load_twosided(const Plugin& plugin);
BsdfKind load_mask(const Plugin& plugin);
BsdfKind load_blend(const Plugin& plugin);
BsdfKind load_normal_map(const Plugin& plugin);
BsdfKind load_bump_map(const Plugin& plugin);

}  // namespace tachylite
