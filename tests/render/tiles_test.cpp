// Many small surfaces in one image, each lit directly: textures of every format, wrap mode, filter and transform, and
// materials nested in one another, on the device and by the CPU reference. Each tile's mean is a test of its own; the
// level of all together is 1e-4. Power: a tile that is 5 % (textures: 3 %) off in one channel is found with probability
// 0.95.

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reference/reference.h"
#include "support/chi2.h"
#include "support/image_files.h"
#include "support/render_test.h"

namespace tachylite::test {
namespace {

constexpr int kTile = 8;  // pixels
constexpr int kColumns = 8;

struct Tile {
  std::string name, shape, bsdf;  // shape: the plugin
};
using Files = std::vector<std::pair<std::string, std::string>>;

std::string bytes16(int value) { return {static_cast<char>(value & 255), static_cast<char>(value >> 8)}; }

/// A Targa whose texels differ from each other and between channels.
std::string targa(int width, int height, int channels, int low, int high) {
  std::vector<uint8_t> texels;
  for (int i = 0; i < width * height * channels; ++i)
    texels.push_back(static_cast<uint8_t>(low + i * 7919 % (high - low)));
  return tga_file(width, height, channels, texels);
}

std::string radiance(int width, int height) {
  std::vector<float> rgb;
  for (int i = 0; i < width * height; ++i)
    for (const int step : {53, 97, 31}) rgb.push_back(static_cast<float>(40 + i * step % 180) / 256);
  return hdr_file(width, height, rgb);
}

/// Bitmap of Windows, 24 bits, rows from the bottom.
std::string windows_bitmap(int width, int height) {
  const int stride = (3 * width + 3) / 4 * 4, size = 54 + stride * height;
  std::string file = "BM" + bytes16(size) + bytes16(0) + std::string(4, 0) + bytes16(54) + bytes16(0);
  file += bytes16(40) + bytes16(0) + bytes16(width) + bytes16(0) + bytes16(height) + bytes16(0);
  file += bytes16(1) + bytes16(24) + std::string(24, 0);
  for (int y = 0; y < height; ++y)
    for (int i = 0; i < stride; ++i) file += static_cast<char>(60 + (y * stride + i) * 131 % 180);
  return file;
}

std::string boolean(const char* name, bool value) {
  return fmt::format(R"(<boolean name="{}" value="{}"/>)", name, value);
}
std::string bitmap(const std::string& name, const std::string& file, const std::string& more = "") {
  return fmt::format(R"(<texture name="{}" type="bitmap"><string name="filename" value="{}"/>{}</texture>)", name, file,
                     more);
}
std::string word(const char* name, const char* value) {
  return fmt::format(R"(<string name="{}" value="{}"/>)", name, value);
}
std::string bsdf(const std::string& type, const std::string& inside) {
  return fmt::format(R"(<bsdf type="{}">{}</bsdf>)", type, inside);
}
std::string diffuse(const std::string& texture) { return bsdf("diffuse", texture); }
std::string grey(const char* name, double value) {
  return fmt::format(R"(<float name="{}" value="{}"/>)", name, value);
}
std::string rgb(const char* name, const char* value) {
  return fmt::format(R"(<rgb name="{}" value="{}"/>)", name, value);
}

/// Expects that device and reference agree on every tile. `light`: what shines on them; the camera looks along -z.
/// bias: relative, of a tile, to be found with probability 0.95.
void expect_tiles_agree(const std::vector<Tile>& tiles, const Files& files, const std::string& light, uint64_t samples,
                        double bias) {
  const int rows = (static_cast<int>(tiles.size()) + kColumns - 1) / kColumns;
  std::string elements = R"(<integrator type="path"><integer name="max_depth" value="2"/></integrator>)" + light +
                         fmt::format(R"(<sensor type="orthographic"><transform name="to_world"><scale x="{0}" y="{0}"/>
<lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform><film type="hdrfilm">
<integer name="width" value="{1}"/>
<integer name="height" value="{2}"/><rfilter type="box"/></film></sensor>)",
                                     kColumns, kTile * kColumns, kTile * rows);
  for (size_t i = 0; i < tiles.size(); ++i) {
    const int column = static_cast<int>(i) % kColumns, row = static_cast<int>(i) / kColumns;
    // Turned and stretched where the shape allows it, so that dp_du, dp_dv and the axes of the world all differ.
    const bool round = tiles[i].shape == "sphere" || tiles[i].shape == "cylinder";
    elements += fmt::format(R"(<shape type="{}"><transform name="to_world"><scale x="0.8" y="{}" z="{}"/>
<rotate z="1" angle="{}"/><rotate x="1" angle="{}"/><translate x="{}" y="{}"/></transform>{}</shape>)",
                            tiles[i].shape, round ? 0.8 : 0.6, round ? 0.8 : 0.7, 20 + 7 * static_cast<int>(i),
                            round ? 70 : 25, 2 * column + 1 - kColumns, rows - 2 * row - 1, tiles[i].bsdf);
  }
  const Scene scene = scene_from_elements(elements, files);
  RenderOptions options;
  options.samples = samples;
  const DeviceRender rendered = render_on_device(scene, options);
  EXPECT_EQ(rendered.statistics.nonfinite, 0u);
  ReferenceOptions reference_options;
  reference_options.samples = samples;
  reference_options.seed = 99;
  const ReferenceImage reference = render_reference(scene, reference_options);
  const double limit = 5.2;  // normal deviates: two-sided level 2e-7, 1e-4 for up to 500 means
  ASSERT_GT(sidak(1e-4, static_cast<int>(3 * tiles.size())), std::erfc(limit / std::sqrt(2.0)));
  for (size_t i = 0; i < tiles.size(); ++i) {
    const int x0 = static_cast<int>(i) % kColumns * kTile, y0 = static_cast<int>(i) / kColumns * kTile;
    glm::dvec3 device{0}, judge{0}, variance{0};
    for (int y = y0; y < y0 + kTile; ++y)
      for (int x = x0; x < x0 + kTile; ++x) {
        const auto pixel = static_cast<size_t>(y * kTile * kColumns + x);
        device += rendered.film.mean(pixel);
        judge += reference.film.mean(pixel);
        variance += rendered.film.variance_of_mean(pixel) + reference.film.variance_of_mean(pixel);
      }
    for (int c = 0; c < 3; ++c) {
      const double error = std::sqrt(variance[c]);
      EXPECT_LT(std::abs(device[c] - judge[c]), limit * error + 1e-5 * judge[c])
          << tiles[i].name << ", channel " << c << ": " << device[c] << " against " << judge[c];
      EXPECT_LT((limit + 1.65) * error, bias * judge[c]) << tiles[i].name << ", channel " << c << ": no power";
      EXPECT_GT(judge[c], 0.1) << tiles[i].name;
    }
  }
}

struct Tiles : DeviceTest {};

TEST_F(Tiles, Textures) {
  const Files files = {{"rgb.tga", targa(5, 3, 3, 30, 250)}, {"grey.tga", targa(4, 5, 1, 30, 250)},
                       {"rgba.tga", targa(3, 4, 4, 30, 250)}, {"float.hdr", radiance(6, 4)},
                       {"windows.bmp", windows_bitmap(5, 4)}, {"steps.tga", tga_file(2, 2, 1, {20, 90, 160, 250})}};
  std::vector<Tile> tiles;
  const auto add = [&](const std::string& name, const std::string& texture, const char* shape = "rectangle") {
    tiles.push_back({name, shape, diffuse(texture)});
  };
  for (const auto& [file, content] : files)
    for (const bool raw : {false, true})
      add(fmt::format("{} raw {}", file, raw), bitmap("reflectance", file, boolean("raw", raw)));
  const std::string to_uv = R"(<transform name="to_uv"><scale x="2.3" y="1.7"/><rotate z="1" angle="30"/>
<translate x="0.3" y="-0.4"/></transform>)";
  for (const char* wrap : {"repeat", "mirror", "clamp"})
    for (const char* filter : {"nearest", "bilinear"})
      for (const char* file : {"rgb.tga", "float.hdr"})
        add(fmt::format("{} {} {}", file, wrap, filter),
            bitmap("reflectance", file, word("wrap_mode", wrap) + word("filter_type", filter) + to_uv));
  // What lies beyond the image are its other half, its nearer half or its edge: the means differ by 10 % and more.
  const std::string beyond = R"(<transform name="to_uv"><scale x="1.5" y="1.5"/></transform>)";
  for (const char* wrap : {"repeat", "mirror", "clamp"})
    add(fmt::format("beyond the image {}", wrap), bitmap("reflectance", "steps.tga", word("wrap_mode", wrap) + beyond));
  for (const char* shape : {"sphere", "disk", "cylinder", "cube"})
    add(shape, bitmap("reflectance", "rgb.tga", to_uv), shape);
  const std::string colors = rgb("color0", "0.9, 0.2, 0.4") + rgb("color1", "0.3, 0.7, 0.6");
  add("checkerboard", R"(<texture name="reflectance" type="checkerboard">)" + colors + "</texture>");
  add("checkerboard with to_uv", R"(<texture name="reflectance" type="checkerboard">)" + colors + to_uv + "</texture>");
  add("checkerboard of textures",
      R"(<texture name="reflectance" type="checkerboard">)" + bitmap("color0", "rgb.tga", to_uv) +
          R"(<texture name="color1" type="checkerboard">)" + rgb("color0", "0.9, 0.2, 0.4") +
          bitmap("color1", "float.hdr") + "</texture>" + to_uv + "</texture>");
  expect_tiles_agree(tiles, files, R"(<emitter type="constant"/>)", 128, 0.03);
}

/// Front and back, by what stands between and inside the maps. Few classes of material, as each nest of maps costs 5 s
/// to compile; bsdf_energy_test has the mirrors around them.
TEST_F(Tiles, Nestings) {
  const Files files = {{"normal.tga", targa(4, 3, 3, 90, 190)}, {"height.tga", targa(5, 4, 1, 30, 250)},
                       {"weight.tga", targa(3, 3, 1, 30, 250)}};
  const std::string red = diffuse(rgb("reflectance", "0.8, 0.4, 0.3"));
  const std::string blue = diffuse(rgb("reflectance", "0.3, 0.5, 0.9"));
  const std::string glass = bsdf("dielectric", ""), gold = bsdf("conductor", word("material", "Au"));
  const auto normal = [&](const std::string& child, const std::string& more = "") {
    return bsdf("normalmap", bitmap("normalmap", "normal.tga", boolean("raw", true)) + child + more);
  };
  const auto bump = [&](const std::string& child, const std::string& more = "") {
    return bsdf("bumpmap", bitmap("height", "height.tga", boolean("raw", true)) + grey("scale", 0.15) + child + more);
  };
  const auto two_sided = [](const std::string& children) { return bsdf("twosided", children); };
  const auto blend = [&](const std::string& a, const std::string& b) {
    return bsdf("blendbsdf", bitmap("weight", "weight.tga") + a + b);
  };
  const auto mask = [&](const std::string& child) { return bsdf("mask", bitmap("opacity", "weight.tga") + child); };
  const std::string no_flip = boolean("flip_invalid_normals", false);
  const std::string no_shadow = boolean("use_shadowing_function", false);
  std::vector<Tile> tiles;
  const auto add = [&](const std::string& name, const std::string& material, bool front = true, bool behind = false) {
    if (front) tiles.push_back({name, "sphere", material});
    // Seen from behind.
    if (behind) tiles.push_back({name + " from behind", "sphere", material + boolean("flip_normals", true)});
  };
  add("normal", normal(red));
  add("bump", bump(red));
  add("normal bump", normal(bump(red)));
  add("bump normal", bump(normal(red)));
  add("normal normal", normal(normal(red)));
  add("bump bump", bump(bump(red)));
  add("unflipped", normal(bump(red, no_flip), no_flip));
  add("without shadowing", bump(normal(red, no_shadow), no_shadow));
  add("inner without both", normal(bump(red, no_shadow + no_flip)));
  add("two-sided between", normal(two_sided(bump(red))), true, true);
  add("two-sided inside", bump(normal(two_sided(red))), true, true);
  add("two sides in a map", normal(two_sided(red + blue)), true, true);
  add("two sides below two-sided", normal(two_sided(two_sided(red + blue))), true, true);
  // From the side of a map's frame that is not the surface's one sees the other bsdf, by the light behind the surface.
  for (const bool behind : {false, true})
    tiles.push_back({behind ? "two sides in a steep map from behind" : "two sides in a steep map", "rectangle",
                     normal(two_sided(red + blue), no_flip) + boolean("flip_normals", behind)});
  add("mask of null", mask(bsdf("null", "")));
  add("blend of glass and metal", blend(glass, gold));
  expect_tiles_agree(tiles, files, R"(<emitter type="constant"><rgb name="radiance" value="0.4"/></emitter>
<emitter type="directional"><vector name="direction" x="-0.4" y="-0.3" z="-1"/>
<rgb name="irradiance" value="2, 1.8, 1.5"/></emitter>)",
                     192, 0.05);
}

}  // namespace
}  // namespace tachylite::test
