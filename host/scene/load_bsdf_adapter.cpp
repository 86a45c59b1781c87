#include "scene/load_bsdf_adapter.h"

#include "base/error.h"

namespace tachylite {
namespace {

std::vector<BsdfIndex> read_children(const Plugin& plugin, size_t fewest, size_t most) {
  std::vector<BsdfIndex> children;
  for (const XmlNode* node : plugin.objects("bsdf")) children.push_back(plugin.loader().bsdf(*node));
  if (children.size() < fewest || children.size() > most)
    throw InputError(plugin.where(),
                     fmt::format("{} holds {} bsdfs, expected {}{}", plugin.type(), children.size(), fewest,
                                 fewest == most ? "" : fmt::format(" or {}", most)));
  return children;
}

/// The only texture, by any name.
const XmlNode& find_texture(const Plugin& plugin) {
  const XmlNode* node = plugin.object("texture");
  if (!node) throw InputError(plugin.where(), fmt::format("{} holds no texture", plugin.type()));
  return *node;
}

/// The height map; the texture plugin `scale` of 0.6 around it goes into `scale`.
TextureIndex read_height(const Plugin& plugin, double& scale) {
  SceneLoader& loader = plugin.loader();
  const XmlNode& node = find_texture(plugin);
  if (!node.legacy || node.type() != "scale") return loader.texture(node);
  const SceneLoader::Nesting nesting(loader, node);
  const Plugin scaled(loader, node);
  scale *= scaled.real("scale", 1);
  const TextureIndex height = read_height(scaled, scale);
  scaled.finish();
  return height;
}

}  // namespace

bool transmits(const Scene& scene, BsdfIndex index) {
  const BsdfKind& kind = scene.bsdfs[static_cast<size_t>(index)].kind;
  const auto child = [&](BsdfIndex i) { return transmits(scene, i); };
  if (const auto* mask = std::get_if<MaskBsdf>(&kind)) return mask != nullptr;
  if (const auto* blend = std::get_if<BlendBsdf>(&kind)) return child(blend->first) || child(blend->second);
  if (const auto* map = std::get_if<NormalMapBsdf>(&kind)) return child(map->child);
  if (const auto* bump = std::get_if<BumpMapBsdf>(&kind)) return child(bump->child);
  if (const auto* principled = std::get_if<PrincipledBsdf>(&kind))
    return principled->spec_trans.value > 0 || principled->spec_trans.texture != kNone;
  return std::holds_alternative<DielectricBsdf>(kind) || std::holds_alternative<ThinDielectricBsdf>(kind) ||
         std::holds_alternative<RoughDielectricBsdf>(kind) ||
         std::holds_alternative<PrincipledThinBsdf>(kind) || std::holds_alternative<PaperBsdf>(kind) ||
         std::holds_alternative<NullBsdf>(kind);
}

size_t count_leaves(const Scene& scene, const BsdfKind& kind) {
  const auto child = [&](BsdfIndex i) { return count_leaves(scene, scene.bsdfs[static_cast<size_t>(i)].kind); };
  if (const auto* two = std::get_if<TwoSidedBsdf>(&kind))
    return two->front == two->back ? child(two->front) : child(two->front) + child(two->back);
  if (const auto* mask = std::get_if<MaskBsdf>(&kind)) return child(mask->child);
  if (const auto* blend = std::get_if<BlendBsdf>(&kind)) return child(blend->first) + child(blend->second);
  if (const auto* map = std::get_if<NormalMapBsdf>(&kind)) return child(map->child);
  if (const auto* bump = std::get_if<BumpMapBsdf>(&kind)) return child(bump->child);
  return 1;
}

BsdfKind load_twosided(const Plugin& plugin) {
  const auto children = read_children(plugin, 1, 2);
  for (const BsdfIndex child : children)
    if (transmits(plugin.loader().scene, child))
      throw InputError(plugin.where(),
                       fmt::format("twosided cannot hold {}, through which light passes",
                                   plugin.loader().scene.bsdfs[static_cast<size_t>(child)].plugin));
  return TwoSidedBsdf{children.front(), children.back()};
}

BsdfKind load_mask(const Plugin& plugin) {
  return MaskBsdf{read_children(plugin, 1, 1)[0], plugin.scalar("opacity", 0.5, kAny)};
}

BsdfKind load_blend(const Plugin& plugin) {
  const auto children = read_children(plugin, 2, 2);
  if (!plugin.has("weight")) plugin.fail("weight", "a number within [0, 1] or a texture");
  return BlendBsdf{children[0], children[1], plugin.scalar("weight", {}, kUnit)};
}

BsdfKind load_normal_map(const Plugin& plugin) {
  NormalMapBsdf bsdf;
  bsdf.child = read_children(plugin, 1, 1)[0];
  if (plugin.is_color("normalmap"))  // one normal everywhere
    bsdf.normalmap = plugin.loader().constant_texture(
        plugin.where("normalmap"), plugin.constant_color("normalmap", {}, ColorUse::kReflectance));
  else
    bsdf.normalmap = plugin.loader().texture(find_texture(plugin));
  bsdf.flip_invalid_normals = plugin.boolean("flip_invalid_normals", true);
  bsdf.use_shadowing_function = plugin.boolean("use_shadowing_function", true);
  return bsdf;
}

BsdfKind load_bump_map(const Plugin& plugin) {
  BumpMapBsdf bsdf;
  bsdf.child = read_children(plugin, 1, 1)[0];
  bsdf.scale = plugin.real("scale", 1);
  bsdf.height = read_height(plugin, bsdf.scale);
  bsdf.flip_invalid_normals = plugin.boolean("flip_invalid_normals", true);
  bsdf.use_shadowing_function = plugin.boolean("use_shadowing_function", true);
  return bsdf;
}

}  // namespace tachylite
