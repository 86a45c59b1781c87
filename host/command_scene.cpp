#include "command_scene.h"

#include <fmt/format.h>

#include "base/error.h"
#include "scene/aov.h"
#include "scene/load_xml.h"

namespace tachylite {

Scene load_scene_of(const SceneArguments& arguments) {
  LoadOptions options;
  options.permissive = arguments.permissive;
  for (const std::string& define : arguments.defines) {
    const size_t equals = define.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw InputError(fmt::format("-D {}: expected name=value", define));
    options.parameters[define.substr(0, equals)] = define.substr(equals + 1);
  }
  Scene scene = load_scene(arguments.file, options);
  if (arguments.sensor < 0 || static_cast<size_t>(arguments.sensor) >= scene.sensors.size())
    throw InputError(fmt::format("--sensor {}: the scene has {} sensor{}, counted from 0", arguments.sensor,
                                 scene.sensors.size(), scene.sensors.size() == 1 ? "" : "s"));
  std::vector<std::string>& aovs = scene.integrator.aovs;
  aovs.insert(aovs.end(), arguments.aovs.begin(), arguments.aovs.end());
  try {
    parse_aovs(aovs);
  } catch (const InputError& error) {
    throw InputError(fmt::format("--aov: {}", error.what()));
  }
  return scene;
}

uint64_t count_triangles(const Scene& scene) {
  uint64_t triangles = 0;
  for (const Shape& shape : scene.shapes) {
    if (const auto* mesh = std::get_if<MeshShape>(&shape.kind)) triangles += mesh->mesh->triangles.size();
    if (std::holds_alternative<CubeShape>(shape.kind)) triangles += 12;
    if (std::holds_alternative<RectangleShape>(shape.kind)) triangles += 2;
  }
  return triangles;
}

std::string summarize(const Scene& scene, int sensor) {
  const Film& film = scene.sensors[static_cast<size_t>(sensor)].film;
  return fmt::format("{}: {} x {} pixels, {} shapes, {} triangles, {} emitters", scene.path, film.crop_width,
                     film.crop_height, scene.shapes.size(), count_triangles(scene), scene.emitters.size());
}

}  // namespace tachylite
