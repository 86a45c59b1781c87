// Identities of materials, bit for bit, and finite answers everywhere: on the device.

#include <cmath>
#include <cstring>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "statistics/bsdf_materials.h"
#include "statistics/bsdf_probe.h"
#include "support/device_test.h"

namespace tachylite::test {
namespace {

std::vector<BsdfQuery> queries_for(int bsdf, int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0, 0.9999f);
  std::vector<BsdfQuery> queries;
  for (int i = 0; i < count; ++i) {
    const auto sphere = [&](float z) {
      const float phi = 6.2831853f * uniform(random), r = std::sqrt(std::max(0.0f, 1 - z * z));
      return glm::vec3(r * std::cos(phi), r * std::sin(phi), z);
    };
    // A quarter of the directions graze, to 1e-6.
    const auto cosine = [&] {
      const float z = i % 4 == 0 ? std::pow(10.0f, -6 * uniform(random)) : uniform(random);
      return uniform(random) < 0.3f ? -z : z;
    };
    queries.push_back({.bsdf = bsdf, .wo = sphere(cosine()), .wi = sphere(cosine()),
                       .u = {uniform(random), uniform(random)}, .u_lobe = uniform(random)});
  }
  return queries;
}

struct BsdfIdentity : DeviceTest {
  // Both bsdfs give the same bits.
  void expect_same(std::vector<BsdfKind> children, BsdfKind a, BsdfKind b) {
    children.push_back(a);
    children.push_back(b);
    const int first = static_cast<int>(children.size()) - 2;
    BsdfProbe probe(scene_of_bsdfs(children));
    const auto x = probe.ask(queries_for(first, 4096)), y = probe.ask(queries_for(first + 1, 4096));
    for (size_t i = 0; i < x.size(); ++i) ASSERT_EQ(std::memcmp(&x[i], &y[i], sizeof(x[i])), 0) << i;
  }
};

Roughness smooth() {
  Roughness r;
  r.alpha_u = r.alpha_v = 0.0;
  return r;
}

TEST_F(BsdfIdentity, RoughWithoutRoughnessIsSmooth) {
  expect_same({}, RoughDielectricBsdf{1.5, smooth()}, DielectricBsdf{1.5});
  expect_same({}, RoughConductorBsdf{smooth()}, ConductorBsdf{});
  expect_same({}, RoughPlasticBsdf{1.49, smooth()}, PlasticBsdf{1.49});
  // Below the roughness that rounded directions can tell from none.
  for (const auto d : {MicrofacetDistribution::kGgx, MicrofacetDistribution::kBeckmann}) {
    expect_same({}, RoughDielectricBsdf{1.5, {d, 1e-5, 1e-5}}, DielectricBsdf{1.5});
    expect_same({}, RoughConductorBsdf{{d, 1e-5, 1e-5}}, ConductorBsdf{});
  }
}
TEST_F(BsdfIdentity, MatchedIndexIsNothing) {
  expect_same({}, DielectricBsdf{1.0}, NullBsdf{});
  expect_same({}, RoughDielectricBsdf{1.0}, NullBsdf{});
}
TEST_F(BsdfIdentity, PaperAtItsEnds) {
  expect_same({DiffuseBsdf{0.7}}, PaperBsdf{0.7, 0.0}, TwoSidedBsdf{0, 0});
  expect_same({}, PaperBsdf{0.7, 1.0}, NullBsdf{});
}
TEST_F(BsdfIdentity, MaskAndBlendAtTheirEnds) {
  const std::vector<BsdfKind> children = {PlasticBsdf{}, RoughConductorBsdf{}};
  expect_same(children, MaskBsdf{0, 1.0}, PlasticBsdf{});
  expect_same(children, MaskBsdf{0, 0.0}, NullBsdf{});
  expect_same(children, BlendBsdf{0, 1, 0.0}, PlasticBsdf{});
  expect_same(children, BlendBsdf{0, 1, 1.0}, RoughConductorBsdf{});
}

// A texture of one colour is that colour, in every input that may be textured; with it, the two roughnesses of a
// material come by different ways, so that isotropic = anisotropic with equal alphas, too.
TEST_F(BsdfIdentity, ConstantTextureIsItsValue) {
  Scene scene;
  const auto add = [&](double value) { return add_constant_texture(scene, dvec3(value)); };
  const auto color = [&](double value) {
    ColorInput input(value);
    input.texture = add(value);
    return input;
  };
  const auto scalar = [&](double value) {
    ScalarInput input(value);
    input.texture = add(value);
    return input;
  };
  const auto pair = [&](const BsdfKind& constant, const BsdfKind& textured) {
    scene.bsdfs.push_back({.kind = constant});
    scene.bsdfs.push_back({.kind = textured});
  };
  for (const auto d : {MicrofacetDistribution::kGgx, MicrofacetDistribution::kBeckmann}) {
    const Roughness plain{d, 0.25, 0.25}, textured{d, scalar(0.25), 0.25};
    pair(RoughConductorBsdf{plain, 0.5, 2.0, 0.75}, RoughConductorBsdf{textured, color(0.5), color(2.0), color(0.75)});
    pair(RoughDielectricBsdf{1.5, plain, 0.5, 0.75}, RoughDielectricBsdf{1.5, textured, color(0.5), color(0.75)});
  }
  pair(DiffuseBsdf{0.625}, DiffuseBsdf{color(0.625)});
  pair(RoughDiffuseBsdf{0.625, 0.5}, RoughDiffuseBsdf{color(0.625), scalar(0.5)});
  pair(ConductorBsdf{0.5, 2.0, 0.75}, ConductorBsdf{color(0.5), color(2.0), color(0.75)});
  pair(DielectricBsdf{1.5, 0.5, 0.75}, DielectricBsdf{1.5, color(0.5), color(0.75)});
  pair(ThinDielectricBsdf{1.5, 0.5, 0.75}, ThinDielectricBsdf{1.5, color(0.5), color(0.75)});
  pair(PlasticBsdf{1.5, 0.5, 0.75}, PlasticBsdf{1.5, color(0.5), color(0.75)});
  pair(BlinnPhongBsdf{0.5, 0.25, 16.0}, BlinnPhongBsdf{color(0.5), color(0.25), scalar(16.0)});
  pair(MicrofacetBsdf{0.5, 0.25}, MicrofacetBsdf{color(0.5), scalar(0.25)});
  pair(PaperBsdf{0.5, 0.25}, PaperBsdf{color(0.5), scalar(0.25)});
  pair(MaskBsdf{0, 0.25}, MaskBsdf{0, scalar(0.25)});
  pair(BlendBsdf{0, 8, 0.25}, BlendBsdf{0, 8, scalar(0.25)});
  for (const bool nonlinear : {false, true}) {
    pair(PlasticBsdf{1.5, 0.5, 0.75, nonlinear}, PlasticBsdf{1.5, color(0.5), color(0.75), nonlinear});
    pair(RoughPlasticBsdf{1.5, {}, 0.5, 0.75, nonlinear}, RoughPlasticBsdf{1.5, {}, color(0.5), color(0.75), nonlinear});
  }
  const Roughness plain{MicrofacetDistribution::kGgx, 0.5, 0.125};
  const Roughness textured{MicrofacetDistribution::kGgx, scalar(0.5), scalar(0.125)};
  pair(RoughConductorBsdf{plain}, RoughConductorBsdf{textured});
  pair(RoughDielectricBsdf{1.5, plain}, RoughDielectricBsdf{1.5, textured});
  pair(BlinnPhongBsdf{0.5, 0.25, 16.0, 1.0}, BlinnPhongBsdf{color(0.5), color(0.25), scalar(16.0), scalar(1.0)});
  pair(BlinnPhongBsdf{0.5, 0.25, 16.0, 0.0}, BlinnPhongBsdf{color(0.5), color(0.25), scalar(16.0), scalar(0.0)});
  // Every parameter another value: exchanged ones show.
  const auto principled = [](const auto& color_of, const auto& scalar_of) {
    PrincipledBsdf b;
    b.eta = 1.5;
    b.base_color = color_of(0.625);
    ScalarInput* inputs[] = {&b.roughness, &b.anisotropic, &b.metallic, &b.spec_trans, &b.spec_tint,
                             &b.sheen, &b.sheen_tint, &b.flatness, &b.clearcoat, &b.clearcoat_gloss};
    for (int i = 0; i < 10; ++i) *inputs[i] = scalar_of((i + 3) / 16.0);
    return b;
  };
  const auto principled_thin = [](const auto& color_of, const auto& scalar_of) {
    PrincipledThinBsdf b;
    b.base_color = color_of(0.625);
    ScalarInput* inputs[] = {&b.roughness, &b.anisotropic, &b.spec_trans, &b.spec_tint, &b.sheen,
                             &b.sheen_tint, &b.flatness, &b.diff_trans};
    for (int i = 0; i < 8; ++i) *inputs[i] = scalar_of((i + 3) / 16.0);
    b.eta = scalar_of(1.75);
    return b;
  };
  const auto constant_color = [](double v) { return ColorInput(v); };
  const auto constant_scalar = [](double v) { return ScalarInput(v); };
  pair(principled(constant_color, constant_scalar), principled(color, scalar));
  pair(principled_thin(constant_color, constant_scalar), principled_thin(color, scalar));
  const size_t count = scene.bsdfs.size();
  BsdfProbe probe(std::move(scene));
  for (size_t i = 0; i < count; i += 2) {
    const auto x = probe.ask(queries_for(static_cast<int>(i), 1024));
    const auto y = probe.ask(queries_for(static_cast<int>(i) + 1, 1024));
    for (size_t k = 0; k < x.size(); ++k) {
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(x[k].f[c], y[k].f[c], 4e-6f * x[k].f[c]) << "material " << i;
        ASSERT_NEAR(x[k].weight[c], y[k].weight[c], 4e-6f * x[k].weight[c]) << "material " << i;
      }
      ASSERT_NEAR(x[k].pdf, y[k].pdf, 4e-6f * x[k].pdf) << "material " << i;
    }
  }
}

// Flat normal and bump maps turn nothing, alone or inside or around another map; and a map that turns is not nothing.
TEST_F(BsdfIdentity, FlatMapsAreNothing) {
  Scene scene;
  const auto texture = [&](const dvec3& value) { return add_constant_texture(scene, value); };
  const auto add = [&](const BsdfKind& kind) { return add_bsdf(scene, kind); };
  const TextureIndex up = texture({0.5, 0.5, 1}), turned = texture({0.65, 0.4, 0.9}), height = texture(dvec3(0.3));
  const auto flat = [&](BsdfIndex child) { return add(NormalMapBsdf{child, up}); };
  const auto bump = [&](BsdfIndex child) { return add(BumpMapBsdf{child, height, 2.0}); };
  const auto turn = [&](BsdfIndex child) { return add(NormalMapBsdf{child, turned}); };
  struct Pair {
    BsdfIndex a, b;
    bool same = true;
  };
  std::vector<Pair> pairs;
  for (const BsdfKind& kind :
       {BsdfKind(RoughConductorBsdf{{MicrofacetDistribution::kGgx, 0.6, 0.2}}),
        BsdfKind(RoughDielectricBsdf{1.5, {MicrofacetDistribution::kBeckmann, 0.4, 0.4}})}) {
    const BsdfIndex plain = add(kind), mapped = turn(plain);
    for (const BsdfIndex nothing : {flat(plain), bump(plain), flat(bump(plain)), flat(flat(plain)), bump(flat(plain))})
      pairs.push_back({nothing, plain});
    for (const BsdfIndex once : {flat(mapped), bump(mapped), turn(flat(plain)), turn(bump(plain))})
      pairs.push_back({once, mapped});
    pairs.push_back({mapped, plain, false});
    pairs.push_back({turn(mapped), mapped, false});
  }
  const BsdfIndex two_sided = add(TwoSidedBsdf{0, 0}), inside = turn(two_sided), below = turn(0);
  const BsdfIndex around = add(TwoSidedBsdf{below, below});
  pairs.push_back({flat(inside), inside});
  pairs.push_back({turn(flat(two_sided)), inside});
  pairs.push_back({turn(add(TwoSidedBsdf{bump(0), kNone})), inside});
  pairs.push_back({bump(around), around});
  BsdfProbe probe(std::move(scene));
  for (const Pair& pair : pairs) {
    const auto x = probe.ask(queries_for(pair.a, 1024)), y = probe.ask(queries_for(pair.b, 1024));
    bool same = true;
    for (size_t k = 0; k < x.size(); ++k) {
      // A bump map computes its frame anew: rounding, amplified where directions graze.
      const auto near = [](float a, float b) { return std::abs(a - b) <= 1e-4f * std::max(std::abs(a), std::abs(b)); };
      same = same && near(x[k].pdf, y[k].pdf) && near(x[k].f_pdf, y[k].f_pdf);
      for (int c = 0; c < 3; ++c) same = same && near(x[k].f[c], y[k].f[c]) && near(x[k].weight[c], y[k].weight[c]);
      if (pair.same) {
        ASSERT_TRUE(same) << pair.a << " is not " << pair.b << ", query " << k << ": f " << x[k].f.x << " " << y[k].f.x
                          << ", pdf " << x[k].f_pdf << " " << y[k].f_pdf << ", sampled " << x[k].pdf << " " << y[k].pdf
                          << ", weight " << x[k].weight.x << " " << y[k].weight.x;
      }
    }
    EXPECT_EQ(same, pair.same) << pair.a << ", " << pair.b;
  }
}

TEST_F(BsdfIdentity, AnswersAreFinite) {
  std::vector<MaterialCase> cases = all_materials();
  for (const MaterialCase& c : rough_materials()) cases.push_back(c);
  std::vector<BsdfKind> kinds;
  for (const MaterialCase& c : cases) kinds.push_back(c.kind);
  BsdfProbe probe(scene_of_bsdfs(kinds));
  for (size_t i = 0; i < cases.size(); ++i) {
    for (const BsdfAnswer& a : probe.ask(queries_for(static_cast<int>(i), 4096))) {
      for (int k = 0; k < 3; ++k) {
        ASSERT_TRUE(std::isfinite(a.weight[k]) && a.weight[k] >= 0) << cases[i].name;
        ASSERT_TRUE(std::isfinite(a.f[k]) && a.f[k] >= 0) << cases[i].name;
      }
      ASSERT_TRUE(std::isfinite(a.pdf) && a.pdf >= 0 && std::isfinite(a.f_pdf) && a.f_pdf >= 0) << cases[i].name;
    }
  }
}

// What a leaf draws at the edge of its domain lies, rounded, outside of it; at eta = 1.0001 refraction hardly bends, and
// that happens often.
TEST_F(BsdfIdentity, BlendsOfNearlyMatchedGlassAreFinite) {
  std::vector<BsdfKind> kinds = {DiffuseBsdf{0.5}};
  for (const auto d : {MicrofacetDistribution::kGgx, MicrofacetDistribution::kBeckmann})
    for (const double eta : {1.0001, 1 / 1.0001, 1.01})
      for (const double alpha : {0.15, 1.0}) {
        kinds.push_back(RoughDielectricBsdf{eta, {d, alpha, alpha}});
        const auto glass = static_cast<BsdfIndex>(kinds.size()) - 1;
        kinds.push_back(BlendBsdf{0, glass, 0.5});
        kinds.push_back(BlendBsdf{glass, glass, 0.5});
      }
  BsdfProbe probe(scene_of_bsdfs(kinds));
  for (size_t i = 1; i < kinds.size(); ++i) {
    for (const BsdfAnswer& a : probe.ask(queries_for(static_cast<int>(i), 4096))) {
      for (int k = 0; k < 3; ++k) {
        // Reflectances are 1; radiance grows by 1.01^2 at most.
        ASSERT_TRUE(a.weight[k] >= 0 && a.weight[k] < 2.5f) << "material " << i << ", weight " << a.weight[k];
        ASSERT_TRUE(std::isfinite(a.f[k]) && a.f[k] >= 0) << "material " << i;
      }
      ASSERT_TRUE(std::isfinite(a.pdf) && a.pdf >= 0 && std::isfinite(a.f_pdf) && a.f_pdf >= 0) << "material " << i;
    }
  }
}

// A white furnace: sampled weights, with the scaling of radiance undone, do not exceed 1 on average.
TEST_F(BsdfIdentity, NoMaterialCreatesLight) {
  std::vector<MaterialCase> cases = all_materials();
  for (const MaterialCase& c : rough_materials()) cases.push_back(c);
  std::vector<BsdfKind> kinds;
  for (const MaterialCase& c : cases) kinds.push_back(c.kind);
  BsdfProbe probe(scene_of_bsdfs(kinds));
  for (size_t i = 0; i < cases.size(); ++i) {
    if (!cases[i].conserves) continue;
    for (const double degrees : {0.0, 45.0, 80.0, 89.0}) {
      auto queries = queries_for(static_cast<int>(i), 8192);
      const double theta = degrees * 3.14159265 / 180;
      for (BsdfQuery& q : queries) q.wo = glm::vec3(std::sin(theta), 0, std::cos(theta));
      double sum = 0, square = 0;
      for (const BsdfAnswer& a : probe.ask(queries)) {
        const double w = double(std::max({a.weight.x, a.weight.y, a.weight.z})) * a.eta * a.eta;
        sum += w;
        square += w * w;
        if (cases[i].name == "dielectric") {
          ASSERT_NEAR(w, 1, 1e-6);
        }
      }
      const double n = 8192, mean = sum / n, error = std::sqrt(std::max(0.0, square / n - mean * mean) / n);
      EXPECT_LE(mean, 1 + 4 * error + 1e-5) << cases[i].name << " at " << degrees;
    }
  }
}

}  // namespace
}  // namespace tachylite::test
