#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace tachylite {

/// Which scene a command works on, and what the command line changes in it.
struct SceneArguments {
  std::filesystem::path file;
  std::vector<std::string> defines;  // name=value
  bool permissive = false;
  int sensor = 0;
  std::vector<std::string> aovs;  // scene/aov.h: added to those of the scene
};

/// Reads the scene. Throws InputError, also for a sensor or auxiliary channel that there is not.
Scene load_scene_of(const SceneArguments& arguments);

/// "cornell-box: 512 x 512 pixels, 12 shapes, 36 triangles"
std::string summarize(const Scene& scene, int sensor);

uint64_t count_triangles(const Scene& scene);

}  // namespace tachylite
