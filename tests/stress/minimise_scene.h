#pragma once

#include <functional>

#include "stress/scene_text.h"

namespace tachylite::test {

/// Drops elements and puts children into the place of their parents while `fails` stays true; in the end no single
/// such step is left that keeps it true. Files that nothing names are dropped.
SceneText minimise_scene(SceneText scene, const std::function<bool(const SceneText&)>& fails);

}  // namespace tachylite::test
