#include "stress/random_scene.h"

namespace tachylite::test {
namespace {

class BsdfMaker {
 public:
  BsdfMaker(RandomSource& random, SceneText& scene, const BsdfChoice& choice)
      : random_(random), scene_(scene), choice_(choice) {}

  /// maps: at most this many normal and bump maps around each other.
  Element make(int adapters, bool transmits, int maps) {
    if (adapters == 0 || !random_.chance(random_.nested() ? 0.65 : 0.4)) return leaf(transmits);
    switch (random_.below(maps > 0 ? 5 : 3)) {
      case 0:
        return twosided(adapters, maps);
      case 1:
        if (!transmits) return twosided(adapters, maps);
        return plugin("bsdf", "mask").add(scalar("opacity", 0, 1)).add(make(adapters - 1, transmits, maps));
      case 2: {
        Element blend = plugin("bsdf", "blendbsdf").add(scalar("weight", 0, 1));
        blend.add(make(adapters - 1, transmits, maps));
        return blend.add(make(adapters - 1, transmits, maps));
      }
      case 3:
        return map("normalmap", adapters, transmits, maps)
            .add(random_texture(random_, scene_, "normalmap", 0.35, 0.95, false));
      default: {
        Element bump = map("bumpmap", adapters, transmits, maps).add(real("scale", random_.uniform(0.01, 0.2)));
        return bump.add(random_texture(random_, scene_, "height", 0, 1, true));
      }
    }
  }

 private:
  Element twosided(int adapters, int maps) {
    const int inside = random_.nested() ? maps : 0;
    Element two = plugin("bsdf", "twosided").add(make(adapters - 1, false, inside));
    if (random_.chance(0.3)) two.add(make(adapters - 1, false, inside));
    return two;
  }

  Element map(const char* type, int adapters, bool transmits, int maps) {
    Element map = plugin("bsdf", type).add(make(adapters - 1, transmits, random_.nested() ? maps - 1 : 0));
    if (random_.chance(0.3)) map.add(boolean("flip_invalid_normals", random_.chance(0.5)));
    if (random_.chance(0.3)) map.add(boolean("use_shadowing_function", random_.chance(0.5)));
    return map;
  }

  Element color(const std::string& name, double low, double high) {
    if (random_.chance(0.25)) return random_texture(random_, scene_, name, low, high, false, choice_.attribute);
    return parameter("rgb", name, random_.rgb(low, high));
  }
  Element scalar(const std::string& name, double low, double high) {
    if (random_.chance(0.2)) return random_texture(random_, scene_, name, low, high, true, choice_.attribute);
    // The ends of the range are cases of their own.
    const int end = random_.number(0, 9);
    return real(name, end == 0 ? low : end == 1 ? high : random_.uniform(low, high));
  }
  void add_color(Element& bsdf, const char* name, double low, double high, double probability = 0.5) {
    if (random_.chance(probability)) bsdf.add(color(name, low, high));
  }

  void add_roughness(Element& bsdf, bool anisotropic, bool textured) {
    if (random_.chance(0.8)) bsdf.add(word("distribution", random_.pick({"beckmann", "ggx"})));
    if (anisotropic && random_.chance(0.3)) {
      bsdf.add(scalar("alpha_u", 0.05, 0.8)).add(scalar("alpha_v", 0.05, 0.8));
    } else if (textured && random_.chance(0.2)) {
      bsdf.add(random_texture(random_, scene_, "alpha", 0.05, 0.9, true, choice_.attribute));
    } else {
      bsdf.add(real("alpha", random_.log_uniform(0.02, 1)));
    }
  }

  /// Below, at or above the outside's; now and then hardly different from it.
  void add_indices(Element& bsdf) {
    if (random_.chance(0.4)) return;
    const int which = random_.number(0, 9);
    const double outside = random_.uniform(1, 1.6);
    const double inside = which == 0 ? outside * 1.0001 : which < 3 ? random_.uniform(1, outside) + 0.01
                                                                   : random_.uniform(1.05, 2.5);
    bsdf.add(real("int_ior", inside)).add(real("ext_ior", outside));
  }

  void add_metal(Element& bsdf) {
    if (random_.chance(0.4)) {
      bsdf.add(word("material", random_.pick({"none", "Au", "Ag", "Al", "Cu", "Cr"})));
    } else {
      bsdf.add(parameter("rgb", "eta", random_.rgb(0.1, 3))).add(parameter("rgb", "k", random_.rgb(0, 5)));
    }
    add_color(bsdf, "specular_reflectance", 0.3, 1, 0.3);
  }

  void add_principled(Element& bsdf, bool thin, bool transmits) {
    add_color(bsdf, "base_color", 0.1, 0.9, 0.9);
    bsdf.add(scalar("roughness", 0.1, 1));
    for (const char* name : {"anisotropic", "spec_tint", "sheen", "sheen_tint", "flatness"})
      if (random_.chance(0.35)) bsdf.add(scalar(name, 0, 1));
    if (transmits && random_.chance(0.4)) bsdf.add(scalar("spec_trans", 0, 1));
    if (thin) {
      if (random_.chance(0.5)) bsdf.add(scalar("diff_trans", 0, 2));
      if (random_.chance(0.5)) bsdf.add(real("eta", random_.uniform(1.05, 2)));
      return;
    }
    for (const char* name : {"metallic", "clearcoat", "clearcoat_gloss"})
      if (random_.chance(0.35)) bsdf.add(scalar(name, 0, 1));
    if (random_.chance(0.3))
      bsdf.add(real("specular", random_.uniform(0, 1)));
    else if (random_.chance(0.4))
      bsdf.add(real("eta", random_.uniform(1.05, 2.2)));
  }

  Element leaf(bool transmits) {
    const std::string type =
        transmits && random_.chance(0.35)
            ? random_.pick({"dielectric", "thindielectric", "roughdielectric", "paper", "principledthin", "null"})
            : random_.pick({"diffuse", "diffuse", "roughdiffuse", "conductor", "roughconductor", "plastic", "roughplastic",
                            "principled", "blinnphong", "microfacet"});
    Element bsdf = plugin("bsdf", type);
    if (type == "diffuse" || type == "roughdiffuse") {
      bsdf.add(color("reflectance", 0, 0.95));
      if (type == "roughdiffuse") bsdf.add(scalar("alpha", 0, 1));
    } else if (type == "conductor" || type == "roughconductor") {
      if (type == "roughconductor") add_roughness(bsdf, true, true);
      add_metal(bsdf);
    } else if (type == "dielectric" || type == "thindielectric" || type == "roughdielectric") {
      if (type == "roughdielectric") add_roughness(bsdf, true, true);
      add_indices(bsdf);
      add_color(bsdf, "specular_reflectance", 0.3, 1, 0.2);
      add_color(bsdf, "specular_transmittance", 0.3, 1, 0.3);
    } else if (type == "plastic" || type == "roughplastic") {
      if (type == "roughplastic") add_roughness(bsdf, false, false);
      add_indices(bsdf);
      add_color(bsdf, "diffuse_reflectance", 0, 0.95, 0.8);
      add_color(bsdf, "specular_reflectance", 0.3, 1, 0.2);
      if (random_.chance(0.4)) bsdf.add(boolean("nonlinear", random_.chance(0.7)));
    } else if (type == "principled" || type == "principledthin") {
      add_principled(bsdf, type == "principledthin", transmits);
    } else if (type == "blinnphong") {
      bsdf.add(color("diffuse_reflectance", 0, 0.5)).add(color("specular_reflectance", 0, 0.5));
      bsdf.add(real("exponent", random_.log_uniform(1, 300)));
      if (random_.chance(0.2)) bsdf.add(random_texture(random_, scene_, "specular_weight", 0, 1, true));
    } else if (type == "microfacet") {
      bsdf.add(color("kd", 0, 0.9)).add(real("alpha", random_.log_uniform(0.05, 0.8)));
      add_indices(bsdf);
    } else if (type == "paper") {
      bsdf.add(color("reflectance", 0, 0.9)).add(scalar("transparency", 0, 1));
    }
    return bsdf;
  }

  RandomSource& random_;
  SceneText& scene_;
  const BsdfChoice& choice_;
};

}  // namespace

Element random_bsdf(RandomSource& random, SceneText& scene, const BsdfChoice& choice) {
  const bool nested = random.nested();
  const int adapters = choice.adapters > 0 && nested ? choice.adapters + 1 : choice.adapters;
  return BsdfMaker(random, scene, choice).make(adapters, choice.transmits, choice.bumped ? 1 + nested : 0);
}

}  // namespace tachylite::test
