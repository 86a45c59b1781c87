#pragma once

#include "stress/scene_text.h"

namespace tachylite::test {

/// The scene of random_scene with all its lengths `factor` times as large: the image is the same but for rounding.
void scale_scene(SceneText& scene, double factor);

}  // namespace tachylite::test
