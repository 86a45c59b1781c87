#include <cmath>

#include "stress/random_scene.h"

namespace tachylite::test {
namespace {

Element look_at_centre(RandomSource& random, double distance) {
  glm::dvec3 at = glm::dvec3(random.direction()) * distance;
  at.x += 0.5;
  at.y = std::abs(at.y);
  Element place = {"transform", {{"name", "to_world"}}, {}};
  return place.add({"lookat",
                    {{"origin", fmt::format("{:.5g}, {:.5g}, {:.5g}", at.x, at.y, at.z)},
                     {"target", random.point(-0.4, 0.4)},
                     {"up", "0.1, 1, 0.05"}},
                    {}});
}

Element area_light(RandomSource& random, SceneText& scene) {
  bool attribute = false;
  const double low = random.chance(0.15) ? 0.03 : 0.3;
  Element shape = random_shape(random, scene, {.low = low, .high = 3 * low, .reach = 1.5}, attribute);
  Element emitter = plugin("emitter", "area");
  const double power = 1.5 / (low * low);
  if (random.chance(0.25))
    emitter.add(random_texture(random, scene, "radiance", 0, std::min(power, 10.0), false, attribute));
  else
    emitter.add(parameter("rgb", "radiance", random.rgb(0.1 * power, power)));
  shape.add(emitter);
  if (random.chance(0.15)) shape.add(boolean("flip_normals", true));
  if (random.chance(0.3)) shape.add(random_bsdf(random, scene, {.adapters = 0}));
  return shape;
}

Element spot_light(RandomSource& random, SceneText& scene) {
  Element spot = plugin("emitter", "spot").add(look_at_centre(random, random.uniform(2, 4)));
  spot.add(parameter("rgb", "intensity", random.rgb(5, 40)));
  const double cutoff = random.uniform(10, 70);
  spot.add(real("cutoff_angle", cutoff));
  if (random.chance(0.5)) spot.add(real("beam_width", random.uniform(0.1, 0.99) * cutoff));
  if (random.chance(0.2)) spot.add(random_texture(random, scene, "texture", 0, 1, false));
  return spot;
}

Element projector(RandomSource& random, SceneText& scene) {
  Element projector = plugin("emitter", "projector").add(look_at_centre(random, random.uniform(2, 4)));
  projector.add(real("fov", random.uniform(15, 60))).add(real("scale", random.uniform(5, 30)));
  if (random.chance(0.8)) return projector.add(random_texture(random, scene, "irradiance", 0, 1, false));
  return projector.add(parameter("rgb", "irradiance", random.rgb(0.2, 1)));
}

Element environment_map(RandomSource& random, SceneText& scene) {
  Element map = plugin("emitter", "envmap");
  map.add(word("filename", random_image(random, scene, 0, random.chance(0.3) ? 20 : 1.5, false, true)));
  if (random.chance(0.5)) map.add(real("scale", random.uniform(0.2, 2)));
  if (random.chance(0.5)) {
    Element place = {"transform", {{"name", "to_world"}}, {}};
    const double angle = random.uniform(0, 360);
    map.add(place.add({"rotate", {{random.pick({"x", "y", "z"}), "1"}, {"angle", fmt::format("{:.4g}", angle)}}, {}}));
  }
  return map;
}

}  // namespace

void add_random_light(RandomSource& random, SceneText& scene, bool& has_environment) {
  std::string kind = random.pick({"area", "area", "area", "constant", "envmap", "point", "directional", "spot",
                                  "projector", "directionalarea"});
  if (has_environment && (kind == "constant" || kind == "envmap")) kind = "area";
  if (kind == "area") return scene.elements.push_back(area_light(random, scene));
  if (kind == "spot") return scene.elements.push_back(spot_light(random, scene));
  if (kind == "projector") return scene.elements.push_back(projector(random, scene));
  if (kind == "envmap") {
    has_environment = true;
    return scene.elements.push_back(environment_map(random, scene));
  }
  if (kind == "directionalarea") {
    Element shape = plugin("shape", random.pick({"rectangle", "disk"})).add(look_at_centre(random, random.uniform(2, 3)));
    return scene.elements.push_back(
        shape.add(plugin("emitter", kind).add(parameter("rgb", "radiance", random.rgb(0.5, 3)))));
  }
  Element emitter = plugin("emitter", kind);
  if (kind == "constant") {
    has_environment = true;
    emitter.add(parameter("rgb", "radiance", random.rgb(0.1, 1)));
  } else if (kind == "point") {
    emitter.add({"point", {{"name", "position"}, {"value", random.point(0.3, 3)}}, {}});
    emitter.add(parameter("rgb", "intensity", random.rgb(2, 20)));
  } else {
    emitter.add({"vector", {{"name", "direction"}, {"value", random.point(-1, 0.1)}}, {}});
    emitter.add(parameter("rgb", "irradiance", random.rgb(0.5, 3)));
  }
  scene.elements.push_back(std::move(emitter));
}

}  // namespace tachylite::test
