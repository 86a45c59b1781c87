#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "scene/index_of_refraction.h"
#include "scene/load_bsdf_adapter.h"
#include "scene/load_objects.h"
#include "scene/parse_value.h"
#include "scene/plugin.h"

namespace tachylite {
namespace {

constexpr auto kReflectance = ColorUse::kReflectance;

double read_ior(const Plugin& plugin, std::string_view name, const char* absent) {
  if (!plugin.has(name)) return *find_index_of_refraction(absent);
  if (plugin.is_string(name)) {
    const auto ior = find_index_of_refraction(plugin.string(name, ""));
    if (!ior) plugin.fail(name, "a number or the name of a material, such as bk7, water or air");
    return *ior;
  }
  return plugin.real(name, 0, kPositive);
}

/// int_ior / ext_ior
double read_eta(const Plugin& plugin, const char* absent_int) {
  const double int_ior = read_ior(plugin, "int_ior", absent_int);
  return int_ior / read_ior(plugin, "ext_ior", "air");
}

MicrofacetDistribution read_distribution(const Plugin& plugin) {
  return plugin.word("distribution", "beckmann", {"beckmann", "ggx"}) == "ggx"
             ? MicrofacetDistribution::kGgx
             : MicrofacetDistribution::kBeckmann;
}

Roughness read_roughness(const Plugin& plugin) {
  Roughness roughness;
  roughness.distribution = read_distribution(plugin);
  plugin.boolean("sample_visible", true);
  if (plugin.has("alpha_u") || plugin.has("alpha_v")) {
    if (plugin.has("alpha"))
      throw InputError(plugin.where("alpha"),
                       fmt::format("{} has alpha as well as alpha_u, alpha_v", plugin.type()));
    if (!plugin.has("alpha_u")) plugin.fail("alpha_u", "a roughness as alpha_v is given");
    if (!plugin.has("alpha_v")) plugin.fail("alpha_v", "a roughness as alpha_u is given");
    roughness.alpha_u = plugin.scalar("alpha_u", {}, kNotNegative);
    roughness.alpha_v = plugin.scalar("alpha_v", {}, kNotNegative);
  } else {
    roughness.alpha_u = roughness.alpha_v = plugin.scalar("alpha", roughness.alpha_u, kNotNegative);
  }
  return roughness;
}

template <typename T>
void read_conductor(const Plugin& plugin, T& bsdf) {
  if (plugin.has("eta") || plugin.has("k")) {
    if (plugin.has("material"))
      throw InputError(plugin.where("material"),
                       fmt::format("{} has material as well as eta, k", plugin.type()));
    bsdf.eta = plugin.color("eta", bsdf.eta, ColorUse::kIor);
    bsdf.k = plugin.color("k", bsdf.k, ColorUse::kIor);
  } else {
    const auto index = find_conductor(plugin.string("material", plugin.node().legacy ? "Cu" : "none"));
    if (!index)
      plugin.fail("material", fmt::format("one of {}; for others give eta and k", list_conductors()));
    bsdf.eta = index->eta;
    bsdf.k = index->k;
  }
  if (plugin.node().legacy) {  // 0.6 divides by the index of what surrounds the metal
    const double outside = read_ior(plugin, "ext_eta", "air");
    for (ColorInput* input : {&bsdf.eta, &bsdf.k}) input->value /= outside;
  }
  bsdf.specular_reflectance = plugin.color("specular_reflectance", bsdf.specular_reflectance, kReflectance);
}

BsdfKind load_diffuse(const Plugin& plugin) {
  const char* name =
      plugin.node().legacy && plugin.has("diffuse_reflectance") ? "diffuse_reflectance" : "reflectance";
  return DiffuseBsdf{plugin.color(name, 0.5, kReflectance)};
}

BsdfKind load_rough_diffuse(const Plugin& plugin) {
  RoughDiffuseBsdf bsdf;
  bsdf.reflectance = plugin.color("reflectance", bsdf.reflectance, kReflectance);
  bsdf.alpha = plugin.scalar("alpha", bsdf.alpha, kNotNegative);
  bsdf.use_fast_approx = plugin.boolean("use_fast_approx", false);
  return bsdf;
}

BsdfKind load_conductor(const Plugin& plugin) {
  ConductorBsdf bsdf;
  read_conductor(plugin, bsdf);
  return bsdf;
}

BsdfKind load_rough_conductor(const Plugin& plugin) {
  RoughConductorBsdf bsdf;
  bsdf.roughness = read_roughness(plugin);
  read_conductor(plugin, bsdf);
  return bsdf;
}

template <typename T>
void read_dielectric(const Plugin& plugin, T& bsdf) {
  bsdf.eta = read_eta(plugin, "bk7");
  bsdf.specular_reflectance = plugin.color("specular_reflectance", bsdf.specular_reflectance, kReflectance);
  bsdf.specular_transmittance =
      plugin.color("specular_transmittance", bsdf.specular_transmittance, kReflectance);
}

template <typename T>
BsdfKind load_smooth_dielectric(const Plugin& plugin) {
  T bsdf;
  read_dielectric(plugin, bsdf);
  return bsdf;
}

BsdfKind load_rough_dielectric(const Plugin& plugin) {
  RoughDielectricBsdf bsdf;
  bsdf.roughness = read_roughness(plugin);
  read_dielectric(plugin, bsdf);
  if (bsdf.eta == 1) throw InputError(plugin.where(), "int_ior and ext_ior of roughdielectric are the same");
  return bsdf;
}

template <typename T>
void read_plastic(const Plugin& plugin, T& bsdf) {
  bsdf.eta = read_eta(plugin, "polypropylene");
  bsdf.diffuse_reflectance = plugin.color("diffuse_reflectance", bsdf.diffuse_reflectance, kReflectance);
  bsdf.specular_reflectance = plugin.color("specular_reflectance", bsdf.specular_reflectance, kReflectance);
  bsdf.nonlinear = plugin.boolean("nonlinear", false);
}

BsdfKind load_plastic(const Plugin& plugin) {
  PlasticBsdf bsdf;
  read_plastic(plugin, bsdf);
  return bsdf;
}

BsdfKind load_rough_plastic(const Plugin& plugin) {
  RoughPlasticBsdf bsdf;
  bsdf.roughness.distribution = read_distribution(plugin);
  plugin.boolean("sample_visible", true);
  bsdf.roughness.alpha_u = bsdf.roughness.alpha_v = plugin.real("alpha", 0.1, kNotNegative);
  read_plastic(plugin, bsdf);
  bsdf.keeps_light_inside = plugin.node().legacy;
  return bsdf;
}

BsdfKind load_principled(const Plugin& plugin) {
  PrincipledBsdf b;
  b.base_color = plugin.color("base_color", b.base_color, kReflectance);
  const auto read = [&](const char* name, ScalarInput& input) { input = plugin.scalar(name, input, kUnit); };
  read("roughness", b.roughness);
  read("anisotropic", b.anisotropic);
  read("metallic", b.metallic);
  read("spec_trans", b.spec_trans);
  read("spec_tint", b.spec_tint);
  read("sheen", b.sheen);
  read("sheen_tint", b.sheen_tint);
  read("flatness", b.flatness);
  read("clearcoat", b.clearcoat);
  read("clearcoat_gloss", b.clearcoat_gloss);
  if (plugin.has("eta") && plugin.has("specular"))
    throw InputError(plugin.where("eta"), "principled has eta as well as specular");
  // eta from Disney's `specular` = ((eta - 1) / (eta + 1))^2 / 0.08. What transmits needs an eta other
  // than 1.
  const bool transmits = b.spec_trans.texture != kNone || b.spec_trans.value > 0;
  if (plugin.has("eta")) {
    b.eta = plugin.real("eta", 1.5, kPositive);
    if (transmits && b.eta == 1) b.eta = 1.001;
  } else {
    double specular = plugin.real("specular", 0.5, kUnit);
    if (transmits && specular == 0) specular = 1e-3;
    b.eta = 2 / (1 - std::sqrt(0.08 * specular)) - 1;
  }
  b.diffuse_reflectance_sampling_rate = plugin.real("diffuse_reflectance_sampling_rate", 1, kNotNegative);
  b.main_specular_sampling_rate = plugin.real("main_specular_sampling_rate", 1, kNotNegative);
  b.clearcoat_sampling_rate = plugin.real("clearcoat_sampling_rate", 1, kNotNegative);
  return b;
}

BsdfKind load_principled_thin(const Plugin& plugin) {
  PrincipledThinBsdf b;
  b.base_color = plugin.color("base_color", b.base_color, kReflectance);
  const auto read = [&](const char* name, ScalarInput& input) { input = plugin.scalar(name, input, kUnit); };
  read("roughness", b.roughness);
  read("anisotropic", b.anisotropic);
  read("spec_trans", b.spec_trans);
  read("spec_tint", b.spec_tint);
  read("sheen", b.sheen);
  read("sheen_tint", b.sheen_tint);
  read("flatness", b.flatness);
  b.eta = plugin.scalar("eta", b.eta, kPositive);
  b.diff_trans = plugin.scalar("diff_trans", b.diff_trans, {0, 2});
  b.diffuse_reflectance_sampling_rate = plugin.real("diffuse_reflectance_sampling_rate", 1, kNotNegative);
  b.specular_reflectance_sampling_rate = plugin.real("specular_reflectance_sampling_rate", 1, kNotNegative);
  b.specular_transmittance_sampling_rate =
      plugin.real("specular_transmittance_sampling_rate", 1, kNotNegative);
  b.diffuse_transmittance_sampling_rate = plugin.real("diffuse_transmittance_sampling_rate", 1, kNotNegative);
  return b;
}

BsdfKind load_blinn_phong(const Plugin& plugin) {
  BlinnPhongBsdf bsdf;
  bsdf.diffuse_reflectance = plugin.color("diffuse_reflectance", bsdf.diffuse_reflectance, kReflectance);
  bsdf.specular_reflectance = plugin.color("specular_reflectance", bsdf.specular_reflectance, kReflectance);
  bsdf.exponent = plugin.scalar("exponent", bsdf.exponent, kNotNegative);
  if (plugin.has("specular_weight")) {
    bsdf.specular_weight = plugin.scalar("specular_weight", {}, kUnit);
  } else if (bsdf.diffuse_reflectance.texture == kNone && bsdf.specular_reflectance.texture == kNone) {
    const dvec3 sum = bsdf.diffuse_reflectance.value + bsdf.specular_reflectance.value;
    if (std::max({sum.x, sum.y, sum.z}) > 1 + 1e-9)
      throw InputError(plugin.where(), "diffuse_reflectance + specular_reflectance of blinnphong exceed 1");
  }
  return bsdf;
}

BsdfKind load_microfacet(const Plugin& plugin) {
  MicrofacetBsdf bsdf;
  bsdf.kd = plugin.color("kd", bsdf.kd, kReflectance);
  bsdf.alpha = plugin.scalar("alpha", bsdf.alpha, kPositive);
  bsdf.int_ior = read_ior(plugin, "int_ior", "bk7");
  bsdf.ext_ior = read_ior(plugin, "ext_ior", "air");
  return bsdf;
}

BsdfKind load_paper(const Plugin& plugin) {
  PaperBsdf bsdf;
  bsdf.reflectance = plugin.color("reflectance", bsdf.reflectance, kReflectance);
  bsdf.transparency = plugin.scalar("transparency", bsdf.transparency, kUnit);
  return bsdf;
}

BsdfKind load_null(const Plugin&) {
  return NullBsdf{};
}

}  // namespace

BsdfKind load_bsdf(SceneLoader& loader, const XmlNode& node) {
  static const std::map<std::string, BsdfKind (*)(const Plugin&)> readers{
      {"diffuse", load_diffuse},
      {"roughdiffuse", load_rough_diffuse},
      {"conductor", load_conductor},
      {"roughconductor", load_rough_conductor},
      {"dielectric", load_smooth_dielectric<DielectricBsdf>},
      {"thindielectric", load_smooth_dielectric<ThinDielectricBsdf>},
      {"roughdielectric", load_rough_dielectric},
      {"plastic", load_plastic},
      {"roughplastic", load_rough_plastic},
      {"principled", load_principled},
      {"principledthin", load_principled_thin},
      {"blinnphong", load_blinn_phong},
      {"microfacet", load_microfacet},
      {"paper", load_paper},
      {"null", load_null},
      {"twosided", load_twosided},
      {"mask", load_mask},
      {"blendbsdf", load_blend},
      {"normalmap", load_normal_map},
      {"bumpmap", load_bump_map},
  };
  const Plugin plugin(loader, node);
  const auto reader = readers.find(plugin.type());
  if (reader == readers.end()) {
    loader.refuse(node.where, fmt::format("the bsdf plugin {} is not supported", plugin.type()));
    return DiffuseBsdf{};
  }
  BsdfKind kind = reader->second(plugin);
  plugin.finish();
  // References let few lines mean very many; to be found before anybody walks over them.
  constexpr size_t kMostLeaves = 64;
  if (const size_t leaves = count_leaves(loader.scene, kind); leaves > kMostLeaves)
    throw InputError(node.where, fmt::format("{} holds {} bsdfs, expected at most {}", plugin.type(), leaves, kMostLeaves));
  return kind;
}

}  // namespace tachylite
