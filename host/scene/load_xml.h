#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "scene/scene.h"

namespace tachylite {

struct LoadOptions {
  std::map<std::string, std::string> parameters;  // -D name=value: values of the scene's $name
  bool permissive = false;                        // unknown plugins and parameters become warnings
};

/// Reads a Mitsuba 3 scene (2.x, and the names of 0.6, too) with all files it refers to.
/// Throws InputError "file:line: what is wrong, what was expected" on anything that is broken, out of range,
/// unknown or unsupported; a returned Scene holds only finite numbers and valid indices.
Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace tachylite
