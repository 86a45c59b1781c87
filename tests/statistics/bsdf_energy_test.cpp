// What physics asks of the device's bsdfs: reciprocity, energy that rough interfaces lose by single scattering, and the
// values of the CPU reference.

#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/pi.h"
#include "reference/bsdf/bsdf.h"
#include "statistics/bsdf_materials.h"
#include "statistics/bsdf_probe.h"
#include "support/chi2.h"
#include "support/device_test.h"

namespace tachylite::test {
namespace {


double sqr(double x) { return x * x; }

Scene scene_of(const std::vector<MaterialCase>& cases) {
  std::vector<BsdfKind> kinds;
  for (const MaterialCase& c : cases) kinds.push_back(c.kind);
  return scene_of_bsdfs(kinds);
}

/// Pairs of directions over the sphere, not closer to the horizon than 0.03, where float32 keeps enough digits.
std::vector<BsdfQuery> pairs_for(int bsdf, int count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto direction = [&] {
    glm::vec3 d;
    do d = {uniform(random), uniform(random), uniform(random)};
    while (glm::length(d) > 1 || std::abs(d.z) < 0.03f * glm::length(d));
    return glm::normalize(d);
  };
  std::vector<BsdfQuery> queries;
  for (int i = 0; i < count; ++i) queries.push_back({.bsdf = bsdf, .wo = direction(), .wi = direction()});
  return queries;
}

double largest(const std::vector<BsdfAnswer>& answers, const std::vector<BsdfQuery>& queries) {
  double result = 0;
  for (size_t i = 0; i < answers.size(); ++i)
    result = std::max(result, double(answers[i].f.y) / std::abs(double(queries[i].wi.z)));
  return result;
}

struct BsdfEnergy : DeviceTest {};

/// f(a, b) n_b^2 = f(b, a) n_a^2, with the index n of the side (radiance is scaled on transmission). Tolerance: float32
/// half vectors, 4e-6 relative in D at alpha 0.1 and more at the horizon.
TEST_F(BsdfEnergy, Reciprocity) {
  const std::vector<MaterialCase> cases = all_materials();
  BsdfProbe probe(scene_of(cases));
  for (size_t i = 0; i < cases.size(); ++i) {
    if (!cases[i].reciprocal) continue;
    std::vector<BsdfQuery> there = pairs_for(static_cast<int>(i), 4096, 3), back = there;
    for (BsdfQuery& q : back) std::swap(q.wo, q.wi);
    const auto x = probe.ask(there), y = probe.ask(back);
    const double scale = largest(x, there);
    const auto n2 = [&](const glm::vec3& w) { return w.z > 0 ? 1.0 : sqr(cases[i].eta); };
    for (size_t k = 0; k < x.size(); ++k) {
      for (int c = 0; c < 3; ++c) {
        const double a = x[k].f[c] / std::abs(there[k].wi.z) * n2(there[k].wi);
        const double b = y[k].f[c] / std::abs(back[k].wi.z) * n2(back[k].wi);
        ASSERT_NEAR(a, b, 1e-3 * std::max(a, b) + 1e-6 * scale)
            << cases[i].name << " cosines " << there[k].wo.z << " " << there[k].wi.z;
      }
    }
  }
}

/// The kernels' values are the reference's, derived apart from them in double precision. Its tables of roughplastic are
/// good to 1e-3, and enter up to three times.
TEST_F(BsdfEnergy, ValuesAreThoseOfTheReference) {
  std::vector<MaterialCase> cases = all_materials();
  for (const MaterialCase& c : rough_materials())
    if (c.alpha >= 0.01) cases.push_back(c);
  const Scene scene = scene_of(cases);
  BsdfProbe probe(scene);
  const reference::Materials materials(scene);
  const reference::TextureCoordinates at;
  const reference::ShadingPoint point{materials, at, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  for (size_t i = 0; i < cases.size(); ++i) {
    const auto queries = pairs_for(static_cast<int>(i), 2048, 7);
    const auto answers = probe.ask(queries);
    const double scale = largest(answers, queries), alpha = std::min(cases[i].alpha, 0.3);
    const bool tables = cases[i].name.starts_with("roughplastic");
    for (size_t k = 0; k < answers.size(); ++k) {
      const glm::dvec3 wo(queries[k].wo), wi(queries[k].wi);
      const glm::dvec3 f =
          reference::eval_bsdf(static_cast<BsdfIndex>(i), point, glm::normalize(wo), glm::normalize(wi));
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(answers[k].f[c], f[c], (tables ? 3e-3 : 1e-3 + 1e-4 / alpha) * f[c] + 1e-6 * scale)
            << cases[i].name << " cosines " << wo.z << " " << wi.z;
      if (HasFailure()) break;
    }
  }
}

/// The same of normal maps, alone and in one another, with what may stand between them; bump maps need a surface:
/// tests/render/tiles_test.cpp.
TEST_F(BsdfEnergy, NestedMapsAreThoseOfTheReference) {
  Scene scene;
  const auto texture = [&](const dvec3& value) { return add_constant_texture(scene, value); };
  const auto add = [&](const BsdfKind& kind) { return add_bsdf(scene, kind); };
  const TextureIndex first = texture({0.7, 0.35, 0.85}), second = texture({0.3, 0.45, 0.9});
  std::vector<BsdfIndex> asked;
  const BsdfIndex metal = add(RoughConductorBsdf{{MicrofacetDistribution::kGgx, 0.6, 0.2}});
  for (const bool flip : {true, false})
    for (const bool shadowing : {true, false}) {
      const BsdfIndex inner = add(NormalMapBsdf{metal, second, flip, shadowing});
      asked.push_back(inner);
      asked.push_back(add(NormalMapBsdf{inner, first, true, shadowing}));
      asked.push_back(add(NormalMapBsdf{inner, first, flip, true}));
      // Mirrors around, between and inside.
      const BsdfIndex mirrored = add(TwoSidedBsdf{metal, metal});
      const BsdfIndex innermost = add(NormalMapBsdf{mirrored, second, flip, shadowing});
      asked.push_back(add(NormalMapBsdf{innermost, first, flip, shadowing}));
      const BsdfIndex between = add(TwoSidedBsdf{inner, inner});
      asked.push_back(add(NormalMapBsdf{between, first, flip, shadowing}));
      const BsdfIndex outer = add(NormalMapBsdf{inner, first, flip, shadowing});
      asked.push_back(add(TwoSidedBsdf{outer, outer}));
    }
  BsdfProbe probe(scene);
  const reference::Materials materials(scene);
  const reference::TextureCoordinates at;
  const reference::ShadingPoint point{materials, at, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  for (const BsdfIndex bsdf : asked) {
    const auto queries = pairs_for(bsdf, 2048, 7);
    const auto answers = probe.ask(queries);
    const double scale = largest(answers, queries);
    size_t lit = 0;
    for (size_t k = 0; k < answers.size(); ++k) {
      const glm::dvec3 wo(queries[k].wo), wi(queries[k].wi);
      const glm::dvec3 f = reference::eval_bsdf(bsdf, point, glm::normalize(wo), glm::normalize(wi));
      EXPECT_NEAR(answers[k].f.y, f.y, 2e-3 * f.y + 1e-5 * scale) << "bsdf " << bsdf << " query " << k;
      lit += f.y > 0 ? 1 : 0;
      if (HasFailure()) return;
    }
    EXPECT_GT(lit, answers.size() / 16) << bsdf;
  }
}

/// Albedo of one scattering at a rough interface: integral over the facets m of D m.z G1(wo) (wo.m) / (wo.z m.z) times
/// what of the light leaves. Midpoint rule in the polar coordinates of slopes over alpha; below 1e-3 off.
double rough_albedo(bool ggx, double alpha, double eta, double cos_o) {
  constexpr int kRadii = 400, kAngles = 64;
  const glm::dvec3 wo(std::sqrt(1 - sqr(cos_o)), 0, cos_o);
  const auto masking = [&](const glm::dvec3& w) {
    const double a = std::abs(w.z) / std::max(alpha * std::hypot(w.x, w.y), 1e-12);
    if (ggx) return 2 / (1 + std::sqrt(1 + 1 / sqr(a)));
    return 2 / (1 + std::erf(a) + std::exp(-a * a) / (a * std::sqrt(kPi)));
  };
  double sum = 0;
  for (int i = 0; i < kRadii; ++i) {
    const double v = (i + 0.5) / kRadii, r = v / (1 - v);
    const double slopes = ggx ? 1 / (kPi * sqr(1 + r * r)) : std::exp(-r * r) / kPi;  // density of the slope over alpha
    for (int j = 0; j < kAngles; ++j) {
      const double phi = 2 * kPi * (j + 0.5) / kAngles;
      const glm::dvec3 m = glm::normalize(glm::dvec3(alpha * r * std::cos(phi), alpha * r * std::sin(phi), 1));
      const double c = glm::dot(wo, m);
      if (c <= 0) continue;
      double leaves = 0, reflected = 1;
      const glm::dvec3 wr = 2 * c * m - wo;
      if (eta != 0) {
        const double cos_t2 = 1 - (1 - c * c) / sqr(eta);
        if (cos_t2 > 0) {
          const double cos_t = std::sqrt(cos_t2);
          reflected = 0.5 * (sqr((c - eta * cos_t) / (c + eta * cos_t)) + sqr((eta * c - cos_t) / (eta * c + cos_t)));
          const glm::dvec3 wt = m * (c / eta - cos_t) - wo / eta;
          if (wt.z < 0) leaves += (1 - reflected) * masking(wt);
        }
      }
      if (wr.z > 0) leaves += reflected * masking(wr);
      sum += slopes * r / sqr(1 - v) * masking(wo) * c / (cos_o * m.z) * leaves;
    }
  }
  return sum * 2 * kPi / (double{kRadii} * kAngles);
}

/// Mean weight (with the scaling of radiance undone) against quadrature. Level 1e-4 over all; sees 0.3 % at alpha 1.
TEST_F(BsdfEnergy, RoughInterfacesLoseWhatQuadratureSays) {
  struct Case {
    bool ggx;
    double alpha, eta;
  };
  std::vector<Case> cases;
  std::vector<BsdfKind> kinds;
  for (const bool ggx : {true, false})
    for (const double alpha : {0.05, 0.3, 1.0})
      for (const double eta : {0.0, 1.5, 1 / 2.4}) {
        cases.push_back({ggx, alpha, eta});
        const Roughness roughness{ggx ? MicrofacetDistribution::kGgx : MicrofacetDistribution::kBeckmann, alpha, alpha};
        if (eta == 0) kinds.push_back(RoughConductorBsdf{roughness});  // reflects all
        else kinds.push_back(RoughDielectricBsdf{eta, roughness});
      }
  BsdfProbe probe(scene_of_bsdfs(kinds));
  constexpr int kSamples = 1 << 15;
  const double level = sidak(1e-4, static_cast<int>(cases.size()) * 3);
  const double sigmas = 4.8;
  ASSERT_GT(level, std::erfc(sigmas / std::sqrt(2.0)));
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(0, 0.9999999f);
  for (size_t i = 0; i < cases.size(); ++i) {
    for (const double cos_o : {1.0, 0.5, 0.1}) {
      std::vector<BsdfQuery> queries(kSamples);
      for (BsdfQuery& q : queries)
        q = {.bsdf = static_cast<int>(i), .wo = {std::sqrt(1 - sqr(cos_o)), 0, cos_o},
             .u = {uniform(random), uniform(random)}, .u_lobe = uniform(random)};
      double sum = 0, square = 0;
      for (const BsdfAnswer& a : probe.ask(queries)) {
        const double w = double(a.weight.y) * sqr(a.eta);
        sum += w;
        square += w * w;
      }
      const double mean = sum / kSamples, error = std::sqrt(std::max(square / kSamples - sqr(mean), 0.0) / kSamples);
      const double expected = rough_albedo(cases[i].ggx, cases[i].alpha, cases[i].eta, cos_o);
      EXPECT_NEAR(mean, expected, sigmas * error + 1e-3 * expected)
          << (cases[i].ggx ? "ggx " : "beckmann ") << cases[i].alpha << " eta " << cases[i].eta << " cos " << cos_o;
    }
  }
}

/// Visible normals leave nothing that could make a firefly: no weight exceeds 1 for alpha from 0 to 1 and directions
/// to 1e-6 above the horizon, but for rounding.
TEST_F(BsdfEnergy, NoWeightOfARoughInterfaceExceedsOne) {
  std::vector<BsdfKind> kinds;
  for (const auto distribution : {MicrofacetDistribution::kGgx, MicrofacetDistribution::kBeckmann})
    for (const double alpha : {0.0, 1e-6, 1e-5, 3e-5, 1e-3, 0.03, 0.2, 1.0}) {
      const Roughness roughness{distribution, alpha, alpha};
      kinds.push_back(RoughConductorBsdf{roughness});
      for (const double eta : {1 / 2.4, 1.0001, 1.5, 2.4}) kinds.push_back(RoughDielectricBsdf{eta, roughness});
    }
  BsdfProbe probe(scene_of_bsdfs(kinds));
  std::mt19937 random(29);
  std::uniform_real_distribution<float> uniform(0, 0.9999999f);
  for (size_t i = 0; i < kinds.size(); ++i) {
    std::vector<BsdfQuery> queries(4096);
    for (BsdfQuery& q : queries) {
      const double z = std::pow(10.0, -6 * uniform(random)), phi = 2 * kPi * uniform(random);
      const double r = std::sqrt(1 - z * z);
      q = {.bsdf = static_cast<int>(i), .wo = {r * std::cos(phi), r * std::sin(phi), uniform(random) < 0.5f ? z : -z},
           .u = {uniform(random), uniform(random)}, .u_lobe = uniform(random)};
    }
    const auto answers = probe.ask(queries);
    for (size_t k = 0; k < answers.size(); ++k) {
      const BsdfAnswer& a = answers[k];
      ASSERT_LE(a.weight.y * a.eta * a.eta, 1.00001f) << "material " << i << " wo.z " << queries[k].wo.z;
      ASSERT_TRUE(std::isfinite(a.pdf) && std::isfinite(a.f.y) && a.weight.y >= 0 && a.f.y >= 0) << i;
    }
  }
}

}  // namespace
}  // namespace tachylite::test
