#include <algorithm>
#include <cmath>

#include "stress/random_scene.h"
#include "support/image_files.h"

namespace tachylite::test {
namespace {

/// An EXR or PNG of any of their kinds.
std::string other_image(RandomSource& random, SceneText& scene, double low, double high, bool grey, bool floats) {
  const int width = random.number(1, 9), height = random.number(1, 9);
  std::string name = fmt::format("image{}.{}", scene.files.size(), floats ? "exr" : "png");
  const bool alpha = !floats && random.chance(0.3), fine = random.chance(0.5);
  const int channels = (grey ? 1 : 3) + alpha;
  const int texels = width * height * channels;
  if (floats) {
    std::vector<float> values;
    for (int i = 0; i < texels; ++i) values.push_back(static_cast<float>(random.uniform(low, high)));
    scene.files.emplace_back(name, exr_file(width, height, channels, !fine, values));
  } else {
    std::vector<uint16_t> values;
    for (int i = 0; i < texels; ++i) {
      const double value = std::clamp(random.uniform(low, high), 0.0, 1.0);
      values.push_back(static_cast<uint16_t>(std::lround((fine ? 65535 : 255) * value)));
    }
    scene.files.emplace_back(name, png_file(width, height, channels, fine ? 16 : 8, values));
  }
  return name;
}

Element make_texture(RandomSource& random, SceneText& scene, const std::string& name, const std::string& use, double low,
                     double high, bool grey, bool attribute, int boards);

/// A colour, or where it may be another texture.
Element square(RandomSource& random, SceneText& scene, const std::string& name, const std::string& use, double low,
               double high, bool attribute, int boards) {
  if (random.nested() && random.chance(0.6))
    return make_texture(random, scene, name, use, low, high, false, attribute, boards);
  return parameter("rgb", name, random.rgb(low, high));
}

/// use: the parameter of the bsdf; name: that, or the square of a checkerboard. boards: at most this many inside one
/// another.
Element make_texture(RandomSource& random, SceneText& scene, const std::string& name, const std::string& use, double low,
                     double high, bool grey, bool attribute, int boards) {
  if (attribute && random.chance(0.3)) {
    Element texture = plugin("texture", name, "mesh_attribute").add(word("name", "vertex_color"));
    return texture.add(real("scale", random.uniform(0.5, 1) * std::min(1.0, high)));
  }
  Element texture;
  const bool map = use == "normalmap" || use == "height";
  if (random.chance(0.3) && (random.nested() ? boards > 0 : !map)) {
    texture = plugin("texture", name, "checkerboard");
    texture.add(square(random, scene, "color0", use, low, high, attribute, boards - 1));
    texture.add(square(random, scene, "color1", use, low, high, attribute, boards - 1));
  } else {
    texture = plugin("texture", name, "bitmap");
    texture.add(word("filename", random_image(random, scene, low, high, grey && random.chance(0.5), random.chance(0.3))));
    if (random.chance(0.5)) texture.add(word("wrap_mode", random.pick({"repeat", "mirror", "clamp"})));
    if (random.chance(0.4)) texture.add(word("filter_type", random.pick({"nearest", "bilinear"})));
    if (use == "normalmap" || random.chance(0.4)) texture.add(boolean("raw", true));
  }
  if (random.chance(0.4)) {
    Element to_uv = {"transform", {{"name", "to_uv"}}, {}};
    const double x = random.uniform(0.5, 4), y = random.uniform(0.5, 4);
    to_uv.add({"scale", {{"x", fmt::format("{:.4g}", x)}, {"y", fmt::format("{:.4g}", y)}}, {}});
    if (random.chance(0.3))
      to_uv.add({"rotate", {{"z", "1"}, {"angle", fmt::format("{:.4g}", random.uniform(0, 360))}}, {}});
    texture.add(to_uv);
  }
  return texture;
}

}  // namespace

std::string random_image(RandomSource& random, SceneText& scene, double low, double high, bool grey, bool floats) {
  if (random.wide() && random.chance(0.6)) return other_image(random, scene, low, high, grey, floats);
  const int width = random.number(2, 7), height = random.number(2, 7);
  const auto texels = static_cast<size_t>(width * height);
  std::string name = fmt::format("image{}.{}", scene.files.size(), floats ? "hdr" : "tga");
  if (floats) {
    std::vector<float> rgb(3 * texels);
    for (float& value : rgb) value = static_cast<float>(random.uniform(low, high));
    scene.files.emplace_back(name, hdr_file(width, height, rgb));
  } else {
    std::vector<uint8_t> bytes((grey ? 1 : 3) * texels);
    for (uint8_t& byte : bytes)
      byte = static_cast<uint8_t>(std::lround(255 * std::clamp(random.uniform(low, high), 0.0, 1.0)));
    scene.files.emplace_back(name, tga_file(width, height, grey ? 1 : 3, bytes));
  }
  return name;
}

Element random_texture(RandomSource& random, SceneText& scene, const std::string& name, double low, double high,
                       bool grey, bool attribute) {
  return make_texture(random, scene, name, name, low, high, grey, attribute, 3);
}

}  // namespace tachylite::test
