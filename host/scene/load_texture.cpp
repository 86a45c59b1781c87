#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "image/exr.h"
#include "image/ldr.h"
#include "scene/load_objects.h"
#include "scene/plugin.h"

namespace tachylite {
namespace {

std::shared_ptr<Bitmap> decode_exr(const std::filesystem::path& file) {
  const Image image = read_exr(file);
  // Colour, with or without alpha, or the only channel as grey.
  std::vector<const std::vector<float>*> channels;
  for (const char* name : {"R", "G", "B", "A"})
    if (const auto* channel = image.find(name)) channels.push_back(channel);
  if (!image.find("R") || !image.find("G") || !image.find("B")) {
    const std::vector<float>* grey = image.find("Y");
    if (!grey && image.names.size() == 1) grey = &image.channels[0];
    if (!grey)
      throw InputError(fmt::format("{}: the EXR file has the channels {}, expected R, G, B or a single one",
                                   file.string(), fmt::join(image.names, " ")));
    channels = {grey};
  }
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = image.width;
  bitmap->height = image.height;
  bitmap->channels = static_cast<int>(channels.size());
  bitmap->half = image.half;
  bitmap->floats.resize(channels.size() * channels[0]->size());
  for (size_t c = 0; c < channels.size(); ++c)
    for (size_t i = 0; i < channels[c]->size(); ++i)
      bitmap->floats[i * channels.size() + c] = (*channels[c])[i];
  return bitmap;
}

/// Grey with alpha keeps the grey; 16 bits become linear floats.
std::shared_ptr<Bitmap> decode_ldr(const std::filesystem::path& file, bool raw) {
  DecodedImage image = read_ldr(file);
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = image.width;
  bitmap->height = image.height;
  const auto stored = static_cast<size_t>(image.channels);
  const size_t kept = stored == 2 ? 1 : stored;
  bitmap->channels = static_cast<int>(kept);
  const size_t texels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  if (stored == kept && image.words.empty()) {
    bitmap->bytes = std::move(image.bytes);
    bitmap->floats = std::move(image.floats);
    return bitmap;
  }
  for (size_t i = 0; i < texels; ++i)
    for (size_t c = 0; c < kept; ++c) {
      if (!image.bytes.empty()) bitmap->bytes.push_back(image.bytes[i * stored + c]);
      if (image.words.empty()) continue;
      const float encoded = static_cast<float>(image.words[i * stored + c]) / 65535.0f;
      bitmap->floats.push_back(raw || c == 3 ? encoded : srgb_to_linear(encoded));
    }
  return bitmap;
}

std::shared_ptr<const Bitmap> decode(const std::filesystem::path& file, bool raw) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  auto bitmap = extension == ".exr" ? decode_exr(file) : decode_ldr(file, raw);
  bitmap->path = file.string();
  const auto channels = static_cast<size_t>(bitmap->channels), width = static_cast<size_t>(bitmap->width);
  for (size_t i = 0; i < bitmap->floats.size(); ++i)
    if (!std::isfinite(bitmap->floats[i]))
      throw InputError(fmt::format("{}: the texel at column {}, row {} is {}, expected a finite number",
                                   file.string(), i / channels % width, i / channels / width,
                                   bitmap->floats[i]));
  return bitmap;
}

/// 0.6 spells the transform of uv as four numbers: uv' = uv * scale + offset.
dmat3 read_to_uv(const Plugin& plugin) {
  const dmat4 to_uv = plugin.transform("to_uv");
  const dvec2 scale(plugin.real("uscale", 1), plugin.real("vscale", 1));
  const dvec2 offset(plugin.real("uoffset", 0), plugin.real("voffset", 0));
  const dmat3 planar{
      {to_uv[0][0], to_uv[0][1], 0}, {to_uv[1][0], to_uv[1][1], 0}, {to_uv[3][0], to_uv[3][1], 1}};
  const dmat3 legacy{{scale.x, 0, 0}, {0, scale.y, 0}, {offset.x, offset.y, 1}};
  return legacy * planar;
}

/// 0.6 has `gamma` (1: linear, -1: sRGB) in the place of `raw`.
bool read_raw(const Plugin& plugin) {
  const bool raw = plugin.boolean("raw", false);
  if (!plugin.node().legacy || !plugin.has("gamma")) return raw;
  const double gamma = plugin.real("gamma", -1);
  if (gamma != 1 && gamma != -1)
    plugin.loader().refuse(plugin.where("gamma"),
                           "gamma of bitmap other than 1 (linear) and -1 (sRGB) is not supported");
  return gamma == 1;
}

BitmapTexture load_bitmap_texture(SceneLoader& loader, const Plugin& plugin, TextureIndex index) {
  BitmapTexture texture;
  texture.raw = read_raw(plugin);
  const std::string wrap = plugin.word("wrap_mode", "repeat", {"repeat", "mirror", "clamp"});
  texture.wrap = wrap == "repeat"   ? WrapMode::kRepeat
                 : wrap == "mirror" ? WrapMode::kMirror
                                    : WrapMode::kClamp;
  const std::string filter =
      plugin.node().legacy ? plugin.word("filter_type", "ewa", {"nearest", "bilinear", "trilinear", "ewa"})
                           : plugin.word("filter_type", "bilinear", {"nearest", "bilinear"});
  texture.filter = filter == "nearest" ? FilterType::kNearest : FilterType::kBilinear;
  plugin.ignore({"format", "accel"});
  if (plugin.node().legacy) plugin.ignore({"max_anisotropy", "cache"});

  const BitmapSlot slot = load_bitmap(loader, plugin.file("filename"), texture.raw);
  loader.defer({}, [&loader, slot, index] {
    auto& waiting = std::get<BitmapTexture>(loader.scene.textures[static_cast<size_t>(index)].kind);
    waiting.bitmap = *slot;
    if (!waiting.bitmap->bytes.empty())
      waiting.format = waiting.raw ? TexelFormat::kUnorm8Linear : TexelFormat::kUnorm8Srgb;
    else
      waiting.format = waiting.bitmap->half ? TexelFormat::kHalf : TexelFormat::kFloat;
  });
  return texture;
}

/// How many checkerboards lie inside one another there, itself among them.
int count_checkerboards(const Scene& scene, const CheckerboardTexture& texture) {
  int inside = 0;
  for (const ColorInput* color : {&texture.color0, &texture.color1}) {
    if (color->texture == kNone) continue;
    const auto& kind = scene.textures[static_cast<size_t>(color->texture)].kind;
    if (const auto* board = std::get_if<CheckerboardTexture>(&kind))
      inside = std::max(inside, count_checkerboards(scene, *board));
  }
  return inside + 1;
}

}  // namespace

BitmapSlot load_bitmap(SceneLoader& loader, const std::filesystem::path& file, bool raw) {
  const std::string key = fmt::format("bitmap {} {}", raw, std::filesystem::weakly_canonical(file).string());
  return loader.deferred_file<Bitmap>(key, [file, raw] { return decode(file, raw); });
}

Texture load_texture(SceneLoader& loader, const XmlNode& node, TextureIndex index) {
  const Plugin plugin(loader, node);
  Texture texture;
  texture.where = node.where;
  texture.to_uv = read_to_uv(plugin);
  if (plugin.type() == "bitmap") {
    texture.kind = load_bitmap_texture(loader, plugin, index);
  } else if (plugin.type() == "checkerboard") {
    CheckerboardTexture checkerboard;
    checkerboard.color0 = plugin.color("color0", checkerboard.color0, ColorUse::kIor);
    checkerboard.color1 = plugin.color("color1", checkerboard.color1, ColorUse::kIor);
    if (count_checkerboards(loader.scene, checkerboard) > kMostCheckerboards)
      throw InputError(node.where,
                       fmt::format("checkerboards inside one another: expected at most {}", kMostCheckerboards));
    texture.kind = checkerboard;
  } else if (plugin.type() == "mesh_attribute") {
    MeshAttributeTexture attribute{plugin.string("name", ""), plugin.real("scale", 1, kNotNegative)};
    if (!attribute.name.starts_with("vertex_") && !attribute.name.starts_with("face_"))
      plugin.fail("name", "vertex_... or face_...");
    texture.kind = attribute;
  } else {
    loader.refuse(node.where, fmt::format("the texture plugin {} is not supported", plugin.type()));
    texture.kind = CheckerboardTexture{dvec3(0.5), dvec3(0.5)};
    return texture;
  }
  plugin.finish();
  return texture;
}

}  // namespace tachylite
