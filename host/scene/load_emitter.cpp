#include <cmath>

#include "base/error.h"
#include "base/log.h"
#include "scene/field_of_view.h"
#include "scene/load_objects.h"
#include "scene/plugin.h"

namespace tachylite {
namespace {

constexpr auto kEmission = ColorUse::kEmission;

PointEmitter load_point(const Plugin& plugin) {
  PointEmitter emitter;
  if (plugin.has("position") && plugin.has("to_world"))
    throw InputError(plugin.where("position"), "point has position as well as to_world");
  emitter.position =
      plugin.has("position") ? plugin.vector("position", {}) : dvec3(plugin.transform("to_world")[3]);
  emitter.intensity = plugin.constant_color("intensity", emitter.intensity, kEmission);
  return emitter;
}

DirectionalEmitter load_directional(const Plugin& plugin) {
  DirectionalEmitter emitter;
  if (plugin.has("direction") && plugin.has("to_world"))
    throw InputError(plugin.where("direction"), "directional has direction as well as to_world");
  emitter.direction =
      plugin.has("direction") ? plugin.vector("direction", {}) : dvec3(plugin.transform("to_world")[2]);
  if (!(glm::length(emitter.direction) > 0)) plugin.fail("direction", "a vector that is not zero");
  emitter.direction = glm::normalize(emitter.direction);
  emitter.irradiance = plugin.constant_color("irradiance", emitter.irradiance, kEmission);
  return emitter;
}

SpotEmitter load_spot(const Plugin& plugin) {
  SpotEmitter emitter;
  emitter.to_world = plugin.transform("to_world");
  emitter.intensity = plugin.constant_color("intensity", emitter.intensity, kEmission);
  const double cutoff = plugin.real("cutoff_angle", 20, {0, 180, true, true});
  emitter.cutoff_angle = glm::radians(cutoff);
  emitter.beam_width = glm::radians(plugin.real("beam_width", cutoff * 0.75, {0, cutoff}));
  if (const XmlNode* texture = plugin.object("texture")) emitter.texture = plugin.loader().texture(*texture);
  return emitter;
}

EnvironmentEmitter load_environment(const Plugin& plugin, size_t index) {
  EnvironmentEmitter emitter;
  emitter.scale = plugin.real("scale", 1, kNotNegative);
  emitter.to_world = plugin.transform("to_world");
  plugin.boolean("mis_compensation", false);
  SceneLoader& loader = plugin.loader();
  const BitmapSlot slot = load_bitmap(loader, plugin.file("filename"), true);
  loader.defer({}, [&loader, slot, index, where = plugin.where("filename")] {
    auto& waiting = std::get<EnvironmentEmitter>(loader.scene.emitters[index].kind);
    const Bitmap& bitmap = **slot;
    waiting.srgb = !bitmap.bytes.empty();
    waiting.bitmap = *slot;
    // Filters of image programs ring below zero next to a sun.
    const auto channels = static_cast<size_t>(bitmap.channels);
    const auto is_negative = [&](size_t i) { return bitmap.floats[i] < 0 && i % channels < 3; };
    size_t negative = 0;
    for (size_t i = 0; i < bitmap.floats.size(); ++i) negative += is_negative(i);
    if (negative == 0) return;
    log_warning(fmt::format("{}: {} negative values of envmap count as 0", where.str(), negative));
    auto clamped = std::make_shared<Bitmap>(bitmap);
    for (size_t i = 0; i < bitmap.floats.size(); ++i)
      if (is_negative(i)) clamped->floats[i] = 0;
    waiting.bitmap = clamped;
  });
  return emitter;
}

ProjectorEmitter load_projector(const Plugin& plugin, size_t index) {
  ProjectorEmitter emitter;
  emitter.to_world = plugin.transform("to_world");
  emitter.scale = plugin.real("scale", 1, kNotNegative);
  const ColorInput irradiance = plugin.color("irradiance", emitter.irradiance_value, kEmission);
  emitter.irradiance = irradiance.texture;
  emitter.irradiance_value = irradiance.value;
  const FieldOfView fov = read_field_of_view(plugin);
  if (irradiance.texture == kNone) {
    emitter.x_fov = fov.along_x(1);
    return emitter;
  }
  // The picture's shape is known when it has been decoded.
  SceneLoader& loader = plugin.loader();
  loader.defer({}, [&loader, fov, index, texture = irradiance.texture] {
    double aspect = 1;
    if (const auto* image =
            std::get_if<BitmapTexture>(&loader.scene.textures[static_cast<size_t>(texture)].kind))
      aspect = static_cast<double>(image->bitmap->width) / image->bitmap->height;
    std::get<ProjectorEmitter>(loader.scene.emitters[index].kind).x_fov = fov.along_x(aspect);
  });
  return emitter;
}

}  // namespace

void load_emitter(SceneLoader& loader, const XmlNode& node, int shape) {
  const Plugin plugin(loader, node);
  const std::string& type = plugin.type();
  const size_t index = loader.scene.emitters.size();
  Emitter& emitter = loader.scene.emitters.emplace_back();
  emitter.where = node.where;
  emitter.plugin = type;
  emitter.shape = shape;
  const bool on_shape = type == "area" || type == "directionalarea";
  if (on_shape && shape == kNone)
    throw InputError(node.where, fmt::format("{} must stand inside a shape", type));
  if (!on_shape && shape != kNone)
    throw InputError(node.where, fmt::format("{} cannot stand inside a shape", type));

  decltype(emitter.kind) kind;
  if (type == "area") {
    kind = AreaEmitter{plugin.color("radiance", 1.0, kEmission)};
  } else if (type == "directionalarea") {
    kind = DirectionalAreaEmitter{plugin.color("radiance", 1.0, kEmission)};
  } else if (type == "constant") {
    kind = ConstantEmitter{plugin.constant_color("radiance", dvec3(1), kEmission)};
  } else if (type == "envmap") {
    kind = load_environment(plugin, index);
  } else if (type == "point") {
    kind = load_point(plugin);
  } else if (type == "directional") {
    kind = load_directional(plugin);
  } else if (type == "spot") {
    kind = load_spot(plugin);
  } else if (type == "projector") {
    kind = load_projector(plugin, index);
  } else {
    loader.scene.emitters.pop_back();
    return loader.refuse(node.where, fmt::format("the emitter plugin {} is not supported", type));
  }
  loader.scene.emitters[index].kind = std::move(kind);
  plugin.real("sampling_weight", 1, kNotNegative);  // only affects noise
  plugin.finish();

  const bool everywhere = type == "constant" || type == "envmap";
  for (size_t i = 0; everywhere && i < index; ++i)
    if (loader.scene.emitters[i].plugin == "constant" || loader.scene.emitters[i].plugin == "envmap")
      throw InputError(node.where, "the scene has several environments, expected one");
}

}  // namespace tachylite
