#include "stress/random_scene.h"
#include "support/vol_file.h"

namespace tachylite::test {
namespace {

Element phase_function(RandomSource& random, int depth) {
  if (depth < 2 && random.chance(0.25)) {
    Element blend = plugin("phase", "blendphase").add(real("weight", random.uniform(0, 1)));
    blend.add(phase_function(random, depth + 1));
    return blend.add(phase_function(random, depth + 1));
  }
  if (random.chance(0.4)) return plugin("phase", "isotropic");
  return plugin("phase", "hg").add(real("g", random.uniform(-0.9, 0.9)));
}

/// A .vol file of a few voxels, some of them zero.
std::string grid_file(RandomSource& random, SceneText& scene, int channels, double low, double high) {
  const int nx = random.number(1, 5), ny = random.number(1, 5), nz = random.number(1, 5);
  std::vector<float> values;
  for (int i = 0; i < nx * ny * nz * channels; ++i) {
    const bool empty = random.number(0, 4) == 0;
    values.push_back(static_cast<float>(empty ? low : random.uniform(low, high)));
  }
  std::string name = fmt::format("grid{}.vol", scene.files.size());
  scene.files.emplace_back(name, vol_file({nx, ny, nz}, channels, values));
  return name;
}

Element grid_volume(RandomSource& random, SceneText& scene, const std::string& name, int channels, double low,
                    double high) {
  Element volume = plugin("volume", name, "gridvolume");
  volume.add(word("filename", grid_file(random, scene, channels, low, high)));
  if (random.chance(0.4)) volume.add(word("filter_type", "nearest"));
  if (random.chance(0.3)) volume.add(word("wrap_mode", random.pick({"repeat", "mirror", "clamp"})));
  Element place = {"transform", {{"name", "to_world"}}, {}};
  const double size = random.uniform(1.5, 3);
  place.add({"translate", {{"value", "-0.5, -0.5, -0.5"}}, {}});
  place.add({"scale", {{"value", fmt::format("{:.4g}", size)}}, {}});
  if (random.chance(0.4))
    place.add({"rotate", {{"y", "1"}, {"angle", fmt::format("{:.4g}", random.uniform(0, 90))}}, {}});
  return volume.add(place);
}

}  // namespace

Element random_medium(RandomSource& random, SceneText& scene, const std::string& side) {
  const bool grid = random.chance(0.35);
  Element medium = plugin("medium", side, grid ? "heterogeneous" : "homogeneous");
  const bool fog = side == "medium";
  const double dense = fog ? 0.15 : 3;
  if (grid) {
    medium.add(grid_volume(random, scene, "sigma_t", 1, 0, 1));
    if (random.chance(0.3))
      medium.add(grid_volume(random, scene, "albedo", random.chance(0.5) ? 3 : 1, 0.1, 0.95));
    else
      medium.add(parameter("rgb", "albedo", random.rgb(0.1, 0.95)));
    medium.add(real("scale", random.uniform(0.2, 2) * dense));
  } else {
    if (random.chance(0.4))
      medium.add(real("sigma_t", random.uniform(0.05, 1)));
    else
      medium.add(parameter("rgb", "sigma_t", random.rgb(0.05, 1)));
    if (random.chance(0.4))
      medium.add(real("albedo", random.uniform(0, 0.98)));
    else
      medium.add(parameter("rgb", "albedo", random.rgb(0, 0.98)));
    medium.add(real("scale", random.uniform(0.2, 2) * dense));
  }
  if (random.chance(0.7)) medium.add(phase_function(random, 0));
  return medium;
}

void add_nested_media(RandomSource& random, SceneText& scene) {
  const double size = random.uniform(0.6, 1);
  const glm::dvec3 centre(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
  const auto closed = [&](double scale, const glm::dvec3& offset) {
    Element place = {"transform", {{"name", "to_world"}}, {}};
    place.add({"scale", {{"value", fmt::format("{:.5g}", scale)}}, {}});
    const glm::dvec3 p = centre + offset;
    place.add({"translate", {{"value", fmt::format("{:.5g}, {:.5g}, {:.5g}", p.x, p.y, p.z)}}, {}});
    return plugin("shape", random.pick({"sphere", "cube"})).add(place);
  };
  const auto surface = [&](Element& shape) {
    if (random.chance(0.6)) return shape.add(plugin("bsdf", "null"));
    return shape.add(plugin("bsdf", random.pick({"dielectric", "roughdielectric", "diffuse"})));
  };
  Element outside = random_medium(random, scene, "interior");
  outside.attributes[0] = {"id", "outside"};
  scene.elements.push_back(outside);
  Element shell = closed(size, glm::dvec3(0));
  shell.add({"ref", {{"id", "outside"}, {"name", "interior"}}, {}});
  scene.elements.push_back(surface(shell));
  const int count = random.between(1, 2);
  for (int i = 0; i < count; ++i) {
    // Within the ball of half the shell's size, and apart from each other.
    Element shape = closed(size * random.uniform(0.1, 0.2), glm::dvec3(0.22 * size * (2 * i - 1), 0, 0));
    if (random.chance(0.7)) shape.add(random_medium(random, scene, "interior"));
    shape.add({"ref", {{"id", "outside"}, {"name", "exterior"}}, {}});
    scene.elements.push_back(surface(shape));
  }
}

}  // namespace tachylite::test
