#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/memory.h"
#include "scene/field_of_view.h"
#include "scene/load_objects.h"
#include "scene/parse_transform.h"
#include "scene/plugin.h"

namespace tachylite {
namespace {

constexpr int kMaxFilmSide = 65536;
constexpr int64_t kMaxFilmPixels = int64_t{1} << 28;

void load_filter(SceneLoader& loader, const XmlNode& node, Film& film) {
  const Plugin plugin(loader, node);
  const std::string& type = plugin.type();
  if (type == "box") {
    film.filter = ReconstructionFilter::kBox;
    film.filter_radius = plugin.real("radius", 0.5, {0.5, 64});
  } else if (type == "tent") {
    film.filter = ReconstructionFilter::kTent;
    film.filter_radius = plugin.real("radius", 1, {0, 64, true});
  } else if (type == "gaussian") {
    film.gaussian_stddev = plugin.real("stddev", film.gaussian_stddev, {0, 16, true});
    film.filter_radius = 4 * film.gaussian_stddev;
  } else {
    return loader.refuse(node.where, fmt::format("the rfilter plugin {} is not supported", type));
  }
  plugin.finish();
}

Film load_film(SceneLoader& loader, const XmlNode& node) {
  Film film;
  const Plugin plugin(loader, node);
  if (plugin.type() != "hdrfilm" && plugin.type() != "ldrfilm" && plugin.type() != "mfilm")
    loader.refuse(node.where, fmt::format("the film plugin {} is not supported", plugin.type()));
  film.width = plugin.integer("width", film.width, 1, kMaxFilmSide);
  film.height = plugin.integer("height", film.height, 1, kMaxFilmSide);
  if (int64_t{film.width} * film.height > kMaxFilmPixels)
    throw InputError(plugin.where("width"),
                     fmt::format("the film has {} x {} pixels; at most {} are possible", film.width,
                                 film.height, kMaxFilmPixels));
  film.crop_x = plugin.integer("crop_offset_x", 0, 0, film.width - 1);
  film.crop_y = plugin.integer("crop_offset_y", 0, 0, film.height - 1);
  film.crop_width = plugin.integer("crop_width", film.width - film.crop_x, 1, film.width - film.crop_x);
  film.crop_height = plugin.integer("crop_height", film.height - film.crop_y, 1, film.height - film.crop_y);
  constexpr uint64_t kBytesOfPixel = 9 * sizeof(double);  // sums and squares in double, the image in float
  require_memory(plugin.where("width"), fmt::format("a film of {} x {} pixels", film.crop_width, film.crop_height),
                 kBytesOfPixel * static_cast<uint64_t>(film.crop_width) * static_cast<uint64_t>(film.crop_height));
  if (const XmlNode* filter = plugin.object("rfilter")) load_filter(loader, *filter, film);
  // How a file would be written; and borders, which filters see only with more samples than there are pixels
  // for.
  plugin.ignore({"file_format", "pixel_format", "component_format", "banner", "filename", "attach_log",
                 "high_quality_edges", "sample_border", "compensate"});
  if (node.legacy) plugin.ignore({"gamma", "exposure", "tonemap_method", "key", "burn", "label"});
  plugin.finish();
  return film;
}

void load_sampler(SceneLoader& loader, const XmlNode& node, Sensor& sensor) {
  const Plugin plugin(loader, node);
  constexpr const char* kKnown[] = {"independent", "stratified", "multijitter", "orthogonal",
                                    "ldsampler",   "sobol",      "halton",      "hammersley"};
  if (std::find(std::begin(kKnown), std::end(kKnown), plugin.type()) == std::end(kKnown))
    loader.refuse(node.where, fmt::format("the sampler plugin {} is not supported", plugin.type()));
  sensor.sampler = plugin.type();
  sensor.sample_count = plugin.integer("sample_count", 4, 1);
  sensor.seed = static_cast<uint32_t>(plugin.integer("seed", 0, 0));
  plugin.ignore({"jitter", "strength", "dimension", "scramble"});  // details of patterns that are not used
  plugin.finish();
}

void check_placement(const Plugin& plugin, const dmat4& to_world, bool scale_allowed) {
  const double scale = glm::length(glm::dvec3(to_world[0]));
  if (!scale_allowed && (!is_similarity(to_world, 1e-3) || std::abs(scale - 1) > 1e-3))
    throw InputError(plugin.where("to_world"),
                     fmt::format("to_world of {} must not scale or shear", plugin.type()));
}

}  // namespace

void load_sensor(SceneLoader& loader, const XmlNode& node) {
  const Plugin plugin(loader, node);
  Sensor sensor;
  sensor.where = node.where;
  sensor.id = node.id();
  if (plugin.type() == "thinlens") {
    sensor.kind = Sensor::Kind::kThinLens;
  } else if (plugin.type() == "orthographic") {
    sensor.kind = Sensor::Kind::kOrthographic;
  } else if (plugin.type() != "perspective") {
    throw InputError(node.where, fmt::format("the sensor plugin {} is not supported", plugin.type()));
  }

  // What the image consists of.
  if (const XmlNode* film = plugin.object("film")) sensor.film = load_film(loader, *film);
  if (const XmlNode* sampler = plugin.object("sampler")) load_sampler(loader, *sampler, sensor);
  if (const XmlNode* medium = plugin.object("medium")) sensor.medium = loader.medium(*medium);

  // Where it is and what it sees.
  sensor.to_world = plugin.transform("to_world");
  check_placement(plugin, sensor.to_world, sensor.kind == Sensor::Kind::kOrthographic);
  sensor.near_clip = plugin.real("near_clip", sensor.near_clip, kPositive);
  sensor.far_clip = plugin.real("far_clip", sensor.far_clip, {sensor.near_clip, kAny.high, true});
  if (sensor.kind != Sensor::Kind::kOrthographic) {
    const double aspect = static_cast<double>(sensor.film.width) / sensor.film.height;
    sensor.x_fov = read_field_of_view(plugin).along_x(aspect);
    sensor.principal_point_offset = {plugin.real("principal_point_offset_x", 0),
                                     plugin.real("principal_point_offset_y", 0)};
  }
  if (sensor.kind == Sensor::Kind::kThinLens) {
    if (!plugin.has("aperture_radius")) plugin.fail("aperture_radius", "a length");
    sensor.aperture_radius = plugin.real("aperture_radius", 0, kNotNegative);
    sensor.focus_distance = plugin.real("focus_distance", sensor.far_clip, kPositive);
  } else if (node.legacy) {
    plugin.ignore({"focus_distance"});
  }
  plugin.ignore({"shutter_open", "shutter_close"});
  plugin.finish();
  loader.scene.sensors.push_back(std::move(sensor));
}

}  // namespace tachylite
