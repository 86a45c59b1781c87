#include "stress/random_scene.h"

#include <cmath>

#include "stress/scale_scene.h"

namespace tachylite::test {
namespace {

glm::dvec3 upper_direction(RandomSource& random) {
  const glm::dvec3 d(random.direction());
  return glm::normalize(glm::dvec3(std::abs(d.x), std::abs(d.y) + 0.1, d.z));
}

Element integrator(RandomSource& random, bool media) {
  Element element = plugin("integrator", media                ? random.pick({"volpath", "volpathmis"})
                                         : random.chance(0.1) ? "direct"
                                         : random.chance(0.1) ? "volpath"
                                                              : "path");
  if (*element.attribute("type") == "direct") {
    if (random.chance(0.3)) element.add(integer(random.pick({"emitter_samples", "bsdf_samples"}), 0));
  } else {
    constexpr int kDepths[] = {-1, 1, 2, 3, 4, 5, 6, 8, 12};
    element.add(integer("max_depth", kDepths[random.below(9)]));
    element.add(integer("rr_depth", random.chance(0.5) ? random.between(1, 6) : 1000));
  }
  if (random.chance(0.15)) element.add(boolean("hide_emitters", true));
  if (!random.wide()) return element;
  // `direct` says so by its numbers of samples.
  if (*element.attribute("type") != "direct" && random.chance(0.25))
    element.add(word("sampling", random.pick({"emitter", "bsdf"})));
  if (random.chance(0.15)) element = plugin("integrator", "moment").add(element);
  if (random.chance(0.5))
    element = plugin("integrator", "aov")
                  .add(word("aovs", "albedo, depth, position, sh_normal, geo_normal, uv, dp_du, dp_dv, prim_index, "
                                    "shape_index, sample_count"))
                  .add(element);
  return element;
}

Element film(RandomSource& random) {
  Element film = plugin("film", "hdrfilm");
  const int width = random.number(12, 24), height = random.number(12, 24);
  film.add(integer("width", width)).add(integer("height", height));
  if (random.chance(0.2)) {
    film.add(integer("crop_offset_x", random.number(0, 3))).add(integer("crop_offset_y", random.number(0, 3)));
    film.add(integer("crop_width", random.number(5, width - 3)));
    film.add(integer("crop_height", random.number(5, height - 3)));
  }
  Element filter = plugin("rfilter", random.chance(0.6) ? "box" : random.pick({"tent", "gaussian"}));
  if (*filter.attribute("type") == "gaussian" && random.chance(0.3)) filter.add(real("stddev", random.uniform(0.3, 1)));
  return film.add(filter);
}

Element sensor(RandomSource& random, const Element* medium) {
  const std::string kind = random.chance(0.6) ? "perspective" : random.pick({"thinlens", "orthographic"});
  Element sensor = plugin("sensor", kind);
  const glm::dvec3 at = upper_direction(random) * random.uniform(2.5, 5);
  Element place = {"transform", {{"name", "to_world"}}, {}};
  if (kind == "orthographic") place.add({"scale", {{"value", fmt::format("{:.4g}", random.uniform(0.8, 2))}}, {}});
  place.add({"lookat",
             {{"origin", fmt::format("{:.5g}, {:.5g}, {:.5g}", at.x, at.y, at.z)},
              {"target", random.point(-0.3, 0.3)},
              {"up", fmt::format("{:.3g}, 1, 0.05", random.uniform(-0.5, 0.5))}},
             {}});
  sensor.add(place);
  if (kind != "orthographic") {
    if (random.chance(0.85)) {
      sensor.add(real("fov", random.uniform(25, 70)));
      sensor.add(word("fov_axis", random.pick({"x", "y", "diagonal", "smaller", "larger"})));
    }
    if (random.chance(0.15)) sensor.add(real("principal_point_offset_x", random.uniform(-0.2, 0.2)));
    if (random.chance(0.15)) sensor.add(real("principal_point_offset_y", random.uniform(-0.2, 0.2)));
  }
  if (kind == "thinlens")
    sensor.add(real("aperture_radius", random.uniform(0, 0.4))).add(real("focus_distance", random.uniform(1, 6)));
  if (random.chance(0.1)) sensor.add(real("near_clip", random.uniform(1, 3)));
  if (random.chance(0.1)) sensor.add(real("far_clip", random.uniform(3.5, 6)));
  if (medium) sensor.add(*medium);
  return sensor.add(film(random));
}

void add_objects(RandomSource& random, SceneText& scene, bool media) {
  const int count = random.between(1, 3);
  for (int i = 0; i < count; ++i) {
    const bool filled = media && random.chance(i == 0 ? 0.9 : 0.4);
    bool attribute = false;
    Element shape = random_shape(random, scene, {.closed = filled}, attribute);
    if (random.chance(0.1)) shape.add(boolean("flip_normals", true));
    if (filled && random.chance(0.65))
      shape.add(plugin("bsdf", "null"));
    else if (random.chance(0.95))
      shape.add(random_bsdf(random, scene, {.attribute = attribute}));
    if (filled) shape.add(random_medium(random, scene, "interior"));
    scene.elements.push_back(std::move(shape));
  }
}

void add_surroundings(RandomSource& random, SceneText& scene) {
  const auto wall = [&](const char* axis, double angle, const char* offset) {
    Element place = {"transform", {{"name", "to_world"}}, {}};
    place.add({"scale", {{"value", fmt::format("{:.3g}", random.uniform(2, 4))}}, {}});
    place.add({"rotate", {{axis, "1"}, {"angle", fmt::format("{}", angle)}}, {}});
    place.add({"translate", {{offset, fmt::format("{:.4g}", random.uniform(-1.6, -1))}}, {}});
    Element shape = plugin("shape", "rectangle").add(place);
    Element bsdf = plugin("bsdf", "twosided");
    bsdf.add(random_bsdf(random, scene, {.transmits = false, .adapters = 0}));
    scene.elements.push_back(shape.add(bsdf));
  };
  if (random.chance(0.7)) wall("x", -90, "y");
  if (random.chance(0.2)) wall("y", 90, "x");
}

}  // namespace

SceneText random_scene(uint64_t seed) {
  RandomSource random(seed / kScenesOfTheme + 1, seed + 1, (seed >= kFirstWideSeed) + (seed >= kFirstNestedSeed));
  SceneText scene;
  const bool media = random.chance(0.35);
  const bool fog = media && random.chance(0.2);  // around the camera
  scene.elements.push_back(integrator(random, media));

  Element medium;
  if (fog) medium = random_medium(random, scene, "medium");
  Element in_fog = {"ref", {{"id", "fog"}, {"name", "medium"}}, {}};
  scene.elements.push_back(sensor(random, fog ? &in_fog : nullptr));
  if (fog) {
    medium.attributes[0] = {"id", "fog"};
    scene.elements.push_back(medium);
    Element bound = plugin("shape", "sphere").add(real("radius", random.uniform(5.5, 8))).add(plugin("bsdf", "null"));
    scene.elements.push_back(bound.add({"ref", {{"id", "fog"}, {"name", "interior"}}, {}}));
  }
  add_surroundings(random, scene);
  add_objects(random, scene, media);
  if (random.wide() && media && !fog && random.chance(0.6)) add_nested_media(random, scene);
  bool has_environment = false;
  if (random.chance(0.3)) {  // some light everywhere
    has_environment = true;
    scene.elements.push_back(plugin("emitter", "constant").add(parameter("rgb", "radiance", random.rgb(0.1, 1))));
  }
  const int lights = random.chance(0.1) ? random.between(4, 20) : random.between(1, 3);
  for (int i = 0; i < lights; ++i) add_random_light(random, scene, has_environment);
  if (random.wide() && random.chance(0.5)) scale_scene(scene, random.log_uniform(1e-3, 1e4));
  return scene;
}

}  // namespace tachylite::test
