#include "statistics/bsdf_materials.h"

#include <cmath>

#include <fmt/format.h>

namespace tachylite::test {
namespace {

Roughness rough(MicrofacetDistribution distribution, double alpha_u, double alpha_v) {
  Roughness roughness;
  roughness.distribution = distribution;
  roughness.alpha_u = alpha_u;
  roughness.alpha_v = alpha_v;
  return roughness;
}
constexpr auto kGgx = MicrofacetDistribution::kGgx;
constexpr auto kBeckmann = MicrofacetDistribution::kBeckmann;
const dvec3 kGoldEta(0.143, 0.375, 1.442), kGoldK(3.983, 2.386, 1.603);
const char* name_of(MicrofacetDistribution d) { return d == kGgx ? "ggx" : "beckmann"; }

PrincipledBsdf principled() {
  PrincipledBsdf b;
  b.base_color = dvec3(0.8, 0.5, 0.2);
  b.roughness = 0.5;
  b.eta = 1.5;
  return b;
}
PrincipledThinBsdf principled_thin() {
  PrincipledThinBsdf b;
  b.base_color = dvec3(0.8, 0.5, 0.2);
  b.roughness = 0.5;
  return b;
}

}  // namespace

std::vector<MaterialCase> all_materials() {
  std::vector<MaterialCase> cases;
  const auto add = [&](MaterialCase c) { cases.push_back(std::move(c)); };
  add({.name = "diffuse", .kind = DiffuseBsdf{dvec3(0.9, 0.5, 0.1)}});
  add({.name = "roughdiffuse", .kind = RoughDiffuseBsdf{dvec3(0.9, 0.5, 0.1), 0.7}});
  add({.name = "roughdiffuse fast", .kind = RoughDiffuseBsdf{dvec3(0.9, 0.5, 0.1), 0.3, true}});
  add({.name = "conductor", .kind = ConductorBsdf{kGoldEta, kGoldK}});
  add({.name = "dielectric", .kind = DielectricBsdf{1.5}, .eta = 1.5, .two_sided = true});
  add({.name = "thindielectric", .kind = ThinDielectricBsdf{1.5}, .two_sided = true});
  add({.name = "plastic", .kind = PlasticBsdf{1.49, dvec3(0.9, 0.5, 0.1)}});
  add({.name = "plastic nonlinear", .kind = PlasticBsdf{1.9, dvec3(0.9, 0.5, 0.1), 1.0, true}});
  for (const auto d : {kGgx, kBeckmann}) {
    add({.name = fmt::format("roughconductor {} anisotropic", name_of(d)),
         .kind = RoughConductorBsdf{rough(d, 0.6, 0.25), kGoldEta, kGoldK}, .alpha = 0.25});
    add({.name = fmt::format("roughdielectric {} anisotropic", name_of(d)),
         .kind = RoughDielectricBsdf{1.5, rough(d, 0.3, 0.5)}, .alpha = 0.3, .eta = 1.5, .two_sided = true});
    add({.name = fmt::format("roughplastic {}", name_of(d)),
         .kind = RoughPlasticBsdf{1.49, rough(d, 0.3, 0.3), dvec3(0.9, 0.5, 0.1), 1.0, true, d == kBeckmann},
         .alpha = 0.3});
  }
  add({.name = "blinnphong", .kind = BlinnPhongBsdf{dvec3(0.5, 0.3, 0.1), dvec3(0.4), 12.0}, .alpha = 0.35,
       .conserves = false});
  add({.name = "microfacet", .kind = MicrofacetBsdf{dvec3(0.5, 0.3, 0.1), 0.3}, .alpha = 0.3});
  PrincipledBsdf p = principled();
  add({.name = "principled", .kind = p, .alpha = 0.25});
  p.metallic = 0.7;
  p.anisotropic = 0.8;
  p.spec_tint = 0.4;
  p.sheen = 0.5;
  p.sheen_tint = 0.6;
  p.flatness = 0.5;
  p.clearcoat = 1.0;
  p.clearcoat_gloss = 0.1;
  add({.name = "principled everything but light passing", .kind = p, .alpha = 0.1, .conserves = false});
  p = principled();
  p.spec_trans = 0.7;
  p.metallic = 0.1;
  add({.name = "principled spec_trans", .kind = p, .alpha = 0.25, .eta = 1.5, .two_sided = true});
  PrincipledThinBsdf t = principled_thin();
  add({.name = "principledthin", .kind = t, .alpha = 0.25, .two_sided = true});
  t.spec_trans = 0.6;
  t.anisotropic = 0.4;
  t.diff_trans = 1.2;
  t.spec_tint = 0.5;
  t.sheen = 0.4;
  t.sheen_tint = 0.5;
  t.flatness = 0.5;
  add({.name = "principledthin everything", .kind = t, .alpha = 0.2, .two_sided = true, .conserves = false,
       .reciprocal = false});  // facets that light passes are tested from one side, as by Mitsuba
  return cases;
}

std::vector<MaterialCase> coated_materials() {
  std::vector<MaterialCase> cases;
  for (const double alpha : {0.01, 0.1, 1.0}) {
    for (const auto d : {kGgx, kBeckmann})
      cases.push_back({.name = fmt::format("roughplastic {} {}", name_of(d), alpha),
                       .kind = RoughPlasticBsdf{1.9, rough(d, alpha, alpha), dvec3(0.9, 0.5, 0.1)}, .alpha = alpha});
    cases.push_back({.name = fmt::format("microfacet {}", alpha),
                     .kind = MicrofacetBsdf{dvec3(0.5, 0.3, 0.1), alpha}, .alpha = alpha});
    for (const double spec_trans : {0.0, 0.5}) {
      PrincipledBsdf p = principled();
      p.roughness = std::sqrt(alpha);
      p.spec_trans = spec_trans;
      p.clearcoat = 1.0;
      p.clearcoat_gloss = 0.9;
      cases.push_back({.name = fmt::format("principled {} spec_trans {}", alpha, spec_trans), .kind = p,
                       .alpha = 0.01, .eta = 1.5, .two_sided = spec_trans > 0, .conserves = false});
    }
    PrincipledThinBsdf t = principled_thin();
    t.roughness = std::sqrt(alpha);
    t.spec_trans = 0.5;
    cases.push_back({.name = fmt::format("principledthin {}", alpha), .kind = t, .alpha = alpha, .two_sided = true,
                     .reciprocal = false});
  }
  return cases;
}

std::vector<MaterialCase> rough_materials() {
  std::vector<MaterialCase> cases;
  for (const auto d : {kGgx, kBeckmann}) {
    for (const double alpha : {2.1e-5, 4e-5, 1e-3, 0.01, 0.1, 0.3, 1.0}) {
      cases.push_back({.name = fmt::format("roughconductor {} {}", name_of(d), alpha),
                       .kind = RoughConductorBsdf{rough(d, alpha, alpha), kGoldEta, kGoldK},
                       .alpha = alpha});
      for (const double eta : {1 / 2.4, 1 / 1.5, 1.5, 2.4})
        cases.push_back({.name = fmt::format("roughdielectric {} {} eta {:.3f}", name_of(d), alpha, eta),
                         .kind = RoughDielectricBsdf{eta, rough(d, alpha, alpha)},
                         .alpha = alpha, .eta = eta, .two_sided = true});
    }
  }
  return cases;
}

BsdfIndex add_bsdf(Scene& scene, const BsdfKind& kind) {
  scene.bsdfs.push_back({.kind = kind});
  return static_cast<BsdfIndex>(scene.bsdfs.size()) - 1;
}

TextureIndex add_constant_texture(Scene& scene, const dvec3& value) {
  scene.textures.push_back({{}, dmat3(1), CheckerboardTexture{value, value}});
  return static_cast<TextureIndex>(scene.textures.size()) - 1;
}

}  // namespace tachylite::test
