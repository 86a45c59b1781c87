// Every material of the reference: sampling against density, weights against value, reciprocity, energy. Each
// statistical test has the level 0.01 over all cases and angles together (Sidak), and fixed random numbers.

#include <gtest/gtest.h>

#include "reference/bsdf/bsdf.h"
#include "reference/bsdf/fresnel.h"
#include "support/chi2.h"
#include "unit/reference_support.h"

namespace tachylite {
namespace {

using namespace reference;
using namespace test;

struct Case {
  std::string name;
  bool reciprocal = true;
  double eta = 1;  // below / above
};
void PrintTo(const Case& c, std::ostream* stream) {
  *stream << c.name;
}

Roughness roughness(MicrofacetDistribution distribution, double alpha_u, double alpha_v) {
  return {distribution, alpha_u, alpha_v, true};
}
constexpr auto kGgx = MicrofacetDistribution::kGgx;
constexpr auto kBeckmann = MicrofacetDistribution::kBeckmann;

Texture flat_texture(const dvec3& color) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = bitmap->height = 1;
  bitmap->channels = 3;
  for (int c = 0; c < 3; ++c) bitmap->floats.push_back(static_cast<float>(color[c]));
  Texture texture;
  texture.kind = BitmapTexture{bitmap, TexelFormat::kFloat};
  return texture;
}

BsdfIndex add_case(const std::string& name, SceneBuilder& b) {
  const dvec3 color(0.8, 0.5, 0.2);
  const dvec3 eta(0.2, 0.9, 1.1), k(3.9, 2.4, 2.1);
  if (name == "diffuse") return b.add(DiffuseBsdf{color});
  if (name == "rough_diffuse") return b.add(RoughDiffuseBsdf{color, 0.6});
  if (name == "rough_diffuse_fast") return b.add(RoughDiffuseBsdf{color, 0.6, true});
  if (name == "rough_conductor_ggx") return b.add(RoughConductorBsdf{roughness(kGgx, 0.3, 0.3), eta, k});
  if (name == "rough_conductor_anisotropic")
    return b.add(RoughConductorBsdf{roughness(kBeckmann, 0.5, 0.2), eta, k});
  if (name == "rough_dielectric_ggx") return b.add(RoughDielectricBsdf{1.5, roughness(kGgx, 0.4, 0.4)});
  if (name == "rough_dielectric_beckmann")
    return b.add(RoughDielectricBsdf{1.3, roughness(kBeckmann, 0.4, 0.25)});
  if (name == "rough_dielectric_inverted")
    return b.add(RoughDielectricBsdf{1 / 1.5, roughness(kBeckmann, 0.4, 0.4)});
  if (name == "plastic") return b.add(PlasticBsdf{1.5, color});
  if (name == "plastic_nonlinear") return b.add(PlasticBsdf{1.9, color, 0.7, true});
  if (name == "rough_plastic") return b.add(RoughPlasticBsdf{1.5, roughness(kBeckmann, 0.3, 0.3), color});
  if (name == "principled") {
    PrincipledBsdf p;
    p.base_color = color;
    p.roughness = 0.6, p.anisotropic = 0.5, p.metallic = 0.3, p.spec_tint = 0.4, p.sheen = 0.5;
    p.sheen_tint = 0.3, p.flatness = 0.4, p.clearcoat = 1.0, p.clearcoat_gloss = 0.0, p.eta = 1.5;
    return b.add(p);
  }
  if (name == "principled_transparent") {
    PrincipledBsdf p;
    p.base_color = color;
    p.roughness = 0.6, p.spec_trans = 0.8, p.metallic = 0.1, p.eta = 1.4;
    return b.add(p);
  }
  if (name == "principled_thin") {
    PrincipledThinBsdf p;
    p.base_color = color;
    p.roughness = 0.6, p.anisotropic = 0.3, p.spec_trans = 0.5, p.spec_tint = 0.5, p.sheen = 0.5;
    p.flatness = 0.3, p.eta = 1.6, p.diff_trans = 0.7;
    return b.add(p);
  }
  if (name == "blinn_phong") return b.add(BlinnPhongBsdf{color, dvec3(0.1, 0.4, 0.9), 20.0, std::nullopt});
  if (name == "microfacet") return b.add(MicrofacetBsdf{dvec3(0.4, 0.3, 0.2), 0.3, 1.5, 1});
  if (name == "paper") return b.add(PaperBsdf{color, 0.3});
  if (name == "two_sided")
    return b.add(TwoSidedBsdf{add_case("rough_conductor_ggx", b), add_case("diffuse", b)});
  if (name == "mask") return b.add(MaskBsdf{add_case("rough_plastic", b), 0.6});
  if (name == "blend")
    return b.add(BlendBsdf{add_case("rough_dielectric_ggx", b), add_case("plastic", b), 0.4});
  if (name == "normal_map" || name == "normal_map_plain") {
    const bool options = name == "normal_map";
    const TextureIndex n = b.add_texture(flat_texture({0.6, 0.42, 0.95}));
    return b.add(NormalMapBsdf{add_case("rough_conductor_ggx", b), n, options, options});
  }
  ADD_FAILURE() << "no case " << name;
  return kNone;
}

const Case kCases[] = {{"diffuse"},
                       {"rough_diffuse"},
                       {"rough_diffuse_fast"},
                       {"rough_conductor_ggx"},
                       {"rough_conductor_anisotropic"},
                       {"rough_dielectric_ggx", true, 1.5},
                       {"rough_dielectric_beckmann", true, 1.3},
                       {"rough_dielectric_inverted", true, 1 / 1.5},
                       {"plastic"},
                       {"plastic_nonlinear"},
                       {"rough_plastic"},
                       {"principled"},
                       {"principled_transparent", true, 1.4},
                       {"principled_thin", false},
                       {"blinn_phong"},
                       {"microfacet"},
                       {"paper"},
                       {"two_sided"},
                       {"mask"},
                       {"blend", true, 1.5},
                       {"normal_map", false},
                       {"normal_map_plain", false}};
const dvec3 kViews[] = {glm::normalize(dvec3(0.3, -0.2, 0.8)), glm::normalize(dvec3(-0.7, 0.5, 0.3)),
                        glm::normalize(dvec3(0.4, 0.5, -0.6))};
const double kLevel = sidak(0.01, std::size(kCases) * std::size(kViews));

class ReferenceBsdf : public testing::TestWithParam<Case> {
 protected:
  ReferenceBsdf() : bsdf_(add_case(GetParam().name, builder_)), materials_(builder_.scene) {}
  ShadingPoint point() const { return {materials_, at_, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}}; }

  SceneBuilder builder_;
  BsdfIndex bsdf_;
  Materials materials_;
  TextureCoordinates at_;
};

/// 40000 samples in 16 x 32 bins over the sphere; the message has the deviation seen with power 0.99.
TEST_P(ReferenceBsdf, SamplesItsDensityAndWeighsByIt) {
  const SphereBins bins({.polar_bins = 16, .azimuth_bins = 32, .order = 12});
  for (const dvec3& wo : kViews) {
    SCOPED_TRACE(wo.z);
    std::vector<float> pdf, f;
    for (const glm::vec4& w : bins.quadrature_points()) {
      const dvec3 wi(w.x, w.y, w.z);
      pdf.push_back(static_cast<float>(pdf_bsdf(bsdf_, point(), wo, wi)));
      f.push_back(static_cast<float>(luminance(eval_bsdf(bsdf_, point(), wo, wi))));
    }
    constexpr int kSamples = 40000;
    std::vector<glm::vec4> directions;
    Mean weight;
    Random random(7, 0, 0);
    for (int i = 0; i < kSamples; ++i) {
      const auto sample = sample_bsdf(bsdf_, point(), wo, random);
      const bool smooth = sample && sample->kind == Scattering::kSmooth;
      directions.push_back(smooth ? glm::vec4(sample->wi, 0) : glm::vec4(0));
      weight.add(smooth ? luminance(sample->weight) : 0);
      if (smooth) {
        EXPECT_NEAR(glm::length(sample->wi), 1, 1e-9);
        EXPECT_NEAR(sample->pdf / pdf_bsdf(bsdf_, point(), wo, sample->wi), 1, 1e-9);
      }
    }
    if (bins.integral(pdf) == 0) {  // black from this side
      EXPECT_EQ(weight.mean(), 0);
      EXPECT_EQ(bins.integral(f), 0);
      continue;
    }
    std::vector<double> expected = bins.expected(pdf, kSamples);
    expected.back() = std::max(0.0, expected.back());  // what quadrature leaves of 1
    const auto result = chi2_test(bins.count(directions), expected, kLevel);
    EXPECT_TRUE(result.accepted) << result.message;
    // The quadrature is good to 1e-3 of lobes this wide.
    EXPECT_NEAR(weight.mean(), bins.integral(f), 5 * weight.standard_error() + 1e-3);
  }
}

/// f(wo, wi) / n(wo)^2 = f(wi, wo) / n(wi)^2, n the index of the side (Walter et al. 2007, eq. 3, for
/// radiance).
TEST_P(ReferenceBsdf, IsReciprocal) {
  if (!GetParam().reciprocal) GTEST_SKIP() << "not by design";
  Random random(3, 0, 0);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const dvec3 a = sample_sphere(random.uniform2()), b = sample_sphere(random.uniform2());
    const auto index = [&](const dvec3& w) { return w.z > 0 ? 1 : GetParam().eta; };
    const dvec3 ab = eval_bsdf(bsdf_, point(), a, b) / std::abs(b.z) / sqr(index(a));
    const dvec3 ba = eval_bsdf(bsdf_, point(), b, a) / std::abs(a.z) / sqr(index(b));
    if (!is_black(ab)) ++compared;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(ab[c], ba[c], 1e-9 * (ab[c] + ba[c])) << a.z << " " << b.z;
  }
  EXPECT_GT(compared, 300);
}

/// With all lobes, and the factor 1/eta^2 of radiance undone, no more comes back than went in: mean + 5
/// sigma.
TEST_P(ReferenceBsdf, ConservesEnergy) {
  if (GetParam().name == "principled") GTEST_SKIP() << "Burley's model gains energy at grazing angles";
  if (GetParam().name == "blinn_phong") GTEST_SKIP() << "as it is defined, it reflects up to 4 ks";
  for (const dvec3& wo : kViews) {
    Random random(11, 0, 0);
    Mean albedo;
    for (int i = 0; i < 10000; ++i) {
      const auto sample = sample_bsdf(bsdf_, point(), wo, random);
      albedo.add(sample ? max_component(sample->weight) * sqr(sample->eta) : 0);
    }
    EXPECT_LE(albedo.mean() - 5 * albedo.standard_error(), 1) << wo.z;
  }
}

/// Null lobes are sampled as often as null_transmission says.
TEST_P(ReferenceBsdf, NullLobesMatchTheirTransmission) {
  Random random(5, 0, 0);
  for (const dvec3& wo : kViews) {
    Mean through;
    for (int i = 0; i < 4000; ++i) {
      const auto sample = sample_bsdf(bsdf_, point(), wo, random);
      const bool null = sample && goes_straight(sample->kind);
      if (null) {
        EXPECT_EQ(sample->wi, -wo);
      }
      through.add(null ? sample->weight.y : 0);
    }
    EXPECT_NEAR(through.mean(), null_transmission(bsdf_, point(), wo).y, 5 * through.standard_error());
  }
}

INSTANTIATE_TEST_SUITE_P(All, ReferenceBsdf, testing::ValuesIn(kCases),
                         [](const auto& p) { return p.param.name; });

// ---------------------------------------------------------------------------------------- single statements

TEST(ReferenceFresnel, KnownValues) {
  EXPECT_NEAR(fresnel_dielectric(1, 1.5), 0.04, 1e-15);
  EXPECT_NEAR(fresnel_dielectric(-1, 1.5), 0.04, 1e-15);
  EXPECT_NEAR(fresnel_dielectric(0.5, 1.5), 0.0891867,
              1e-7);                            // Born and Wolf: r_s^2 = .17697, r_p^2 = .00140
  EXPECT_EQ(fresnel_dielectric(-0.5, 1.5), 1);  // beyond the critical angle of 41.8 degrees
  EXPECT_EQ(fresnel_dielectric(0.3, 1), 0);
  // k = 0 is a dielectric, k -> infinity a perfect mirror.
  for (const double c : {0.05, 0.3, 0.7, 1.0}) {
    EXPECT_NEAR(fresnel_conductor(c, dvec3(1.5), dvec3(0)).x, fresnel_dielectric(c, 1.5), 1e-12);
    EXPECT_NEAR(fresnel_conductor(c, dvec3(0), dvec3(1)).x, 1, 1e-12);
  }
  EXPECT_NEAR(fresnel_conductor(1, dvec3(0.2), dvec3(3)).x, (0.64 + 9) / (1.44 + 9), 1e-12);
}

/// The fits of the plugin plastic against quadrature of 2 c F(c).
TEST(ReferenceFresnel, DiffuseReflectanceFits) {
  for (const double eta : {1 / 1.33, 1 / 1.5, 1 / 1.9, 1.33, 1.5, 1.9}) {
    double sum = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const double c = (i + 0.5) / kSteps;
      sum += 2 * c * fresnel_dielectric(c, eta) / kSteps;
    }
    EXPECT_NEAR(fresnel_diffuse_reflectance(eta), sum, 2e-3 * sum) << eta;
  }
}

TEST(ReferenceFresnel, RefractionObeysSnell) {
  for (const double eta : {1.5, 1 / 1.5}) {
    for (const double c : {0.9, 0.8, -0.8, -0.95}) {
      const DielectricBoundary boundary = dielectric_boundary(c, eta);
      const dvec3 w(std::sqrt(1 - c * c), 0, c), t = refract(w, {0, 0, 1}, boundary.cos_t, boundary.eta_ti);
      EXPECT_NEAR(glm::length(t), 1, 1e-14);
      EXPECT_NEAR(-t.x * boundary.eta_ti, w.x, 1e-14);
      EXPECT_LT(t.z * w.z, 0);
    }
  }
}

}  // namespace
}  // namespace tachylite
