#include <variant>

#include "base/error.h"
#include "scene/load_grid.h"
#include "scene/load_objects.h"
#include "scene/parse_color.h"
#include "scene/plugin.h"

namespace tachylite {
namespace {

PhaseFunction load_phase(SceneLoader& loader, const XmlNode& node, int depth) {
  if (depth > 16) throw InputError(node.where, "blendphase is nested too deep");
  const Plugin plugin(loader, node);
  PhaseFunction phase{node.where, IsotropicPhase{}};
  if (plugin.type() == "hg") {
    phase.kind = HenyeyGreensteinPhase{plugin.real("g", 0.8, {-1, 1, true, true})};
  } else if (plugin.type() == "blendphase") {
    const auto children = plugin.objects("phase");
    if (children.size() != 2)
      throw InputError(node.where,
                       fmt::format("blendphase holds {} phase functions, expected 2", children.size()));
    if (!plugin.has("weight")) plugin.fail("weight", "a number within [0, 1]");
    BlendPhase blend;
    blend.first = std::make_shared<PhaseFunction>(load_phase(loader, *children[0], depth + 1));
    blend.second = std::make_shared<PhaseFunction>(load_phase(loader, *children[1], depth + 1));
    blend.weight = plugin.real("weight", 0.5, kUnit);
    phase.kind = blend;
  } else if (plugin.type() != "isotropic") {
    loader.refuse(node.where, fmt::format("the phase plugin {} is not supported", plugin.type()));
    return phase;
  }
  plugin.finish();
  return phase;
}

/// Absorption and scattering of 0.6, or extinction and albedo. Rec.709 triples.
HomogeneousMedium load_homogeneous(const Plugin& plugin) {
  HomogeneousMedium medium;
  // Mitsuba 3 bounds coefficients given as colours by 1, and has `scale` for more; 0.6 does not.
  const bool legacy = plugin.node().legacy;
  const auto coefficient = [&](const char* name, dvec3 absent) {
    const bool bounded = !legacy && plugin.is_color(name);
    return plugin.constant_color(name, absent, bounded ? ColorUse::kReflectance : ColorUse::kIor);
  };
  if (legacy && (plugin.has("sigma_s") || plugin.has("sigma_a"))) {
    const dvec3 sigma_s = coefficient("sigma_s", dvec3(0)), sigma_a = coefficient("sigma_a", dvec3(0));
    medium.sigma_t = sigma_s + sigma_a;
    for (int c = 0; c < 3; ++c) medium.albedo[c] = medium.sigma_t[c] > 0 ? sigma_s[c] / medium.sigma_t[c] : 0;
  } else {
    medium.sigma_t = coefficient("sigma_t", medium.sigma_t);
    medium.albedo = plugin.constant_color("albedo", medium.albedo, ColorUse::kReflectance);
  }
  medium.sigma_t *= plugin.real("scale", 1, kNotNegative);
  return medium;
}

Volume load_volume(SceneLoader& loader, const XmlNode& node, const Plugin& owner, ColorUse use) {
  Volume volume;
  volume.where = node.where;
  if (node.tag != "volume") {
    volume.constant = parse_color(loader, node, owner.type(), use);
    return volume;
  }
  const Plugin plugin(loader, node);
  volume.to_world = plugin.transform("to_world");
  if (plugin.type() == "constvolume") {
    volume.constant = plugin.constant_color("value", volume.constant, use);
  } else if (plugin.type() == "gridvolume") {
    volume.use_grid_bbox = plugin.boolean("use_grid_bbox", false);
    volume.filter = plugin.word("filter_type", "trilinear", {"nearest", "trilinear"}) == "nearest"
                        ? FilterType::kNearest
                        : FilterType::kBilinear;
    const std::string wrap = plugin.word("wrap_mode", "clamp", {"repeat", "mirror", "clamp"});
    volume.wrap = wrap == "repeat"   ? WrapMode::kRepeat
                  : wrap == "mirror" ? WrapMode::kMirror
                                     : WrapMode::kClamp;
    plugin.ignore({"raw", "accel"});
    volume.grid = load_grid(plugin.file("filename"), use == ColorUse::kReflectance);
  } else {
    loader.refuse(node.where, fmt::format("the volume plugin {} is not supported", plugin.type()));
    return volume;
  }
  plugin.finish();
  return volume;
}

HeterogeneousMedium load_heterogeneous(SceneLoader& loader, const Plugin& plugin) {
  HeterogeneousMedium medium;
  medium.scale = plugin.real("scale", 1, kNotNegative);
  medium.albedo.constant = dvec3(0.75);
  const auto read = [&](const char* name, Volume& volume, ColorUse use) {
    const XmlNode* child = plugin.take(name);
    if (child) volume = load_volume(loader, loader.resolve(*child), plugin, use);
  };
  read("sigma_t", medium.sigma_t, ColorUse::kIor);
  read("albedo", medium.albedo, ColorUse::kReflectance);
  return medium;
}

}  // namespace

Medium load_medium(SceneLoader& loader, const XmlNode& node) {
  const Plugin plugin(loader, node);
  Medium medium;
  medium.where = node.where;
  medium.id = node.id();
  medium.phase.where = node.where;
  medium.phase.kind = IsotropicPhase{};
  if (plugin.type() == "homogeneous") {
    medium.kind = load_homogeneous(plugin);
  } else if (plugin.type() == "heterogeneous") {
    medium.kind = load_heterogeneous(loader, plugin);
  } else {
    throw InputError(node.where, fmt::format("the medium plugin {} is not supported", plugin.type()));
  }
  if (const XmlNode* phase = plugin.object("phase")) medium.phase = load_phase(loader, *phase, 0);
  plugin.boolean("sample_emitters", true);  // a strategy: only affects noise
  plugin.boolean("has_spectral_extinction", true);
  plugin.finish();
  return medium;
}

}  // namespace tachylite
