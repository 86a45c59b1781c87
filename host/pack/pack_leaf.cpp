#include "pack/pack_leaf.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "pack/rough_transmittance.h"

namespace tachylite {
namespace {

/// Appends rows in the order in which the leaf's file in shaders/bsdf reads them.
class LeafWriter {
 public:
  LeafWriter(uint32_t type, uint32_t flags, std::span<const uint32_t> row_of_texture)
      : row_of_texture_(row_of_texture) {
    leaf_.type = type;
    leaf_.flags = flags;
  }
  LeafWriter& color(const ColorInput& input) {
    leaf_.rows.push_back(input_row(input.value, texture(input.texture, leaf_.rows.size())));
    return *this;
  }
  LeafWriter& pair(const ScalarInput& x, const ScalarInput& y) {
    const size_t index = leaf_.rows.size();
    glm::uvec4 row = float_row(x.value, y.value);
    row.z = texture(x.texture, index);
    row.w = texture(y.texture, index);
    leaf_.rows.push_back(row);
    return *this;
  }
  LeafWriter& quad(const ScalarInput& x, const ScalarInput& y, const ScalarInput& z, const ScalarInput& w) {
    const size_t index = leaf_.rows.size();
    leaf_.rows.push_back(float_row(x.value, y.value, z.value, w.value));
    leaf_.rows.emplace_back(texture(x.texture, index), texture(y.texture, index), texture(z.texture, index),
                            texture(w.texture, index));
    return *this;
  }
  LeafWriter& constants(double x, double y = 0, double z = 0, double w = 0) {
    leaf_.rows.push_back(float_row(x, y, z, w));
    return *this;
  }
  /// interface_from of bsdf/fresnel.glsl.
  LeafWriter& interface(double eta) {
    const double inverse = 1 / eta;
    return constants(eta, inverse, (eta - 1) * (eta + 1), (inverse - 1) * (inverse + 1));
  }
  LeafWriter& distribution(MicrofacetDistribution distribution) {
    const bool ggx = distribution == MicrofacetDistribution::kGgx;
    leaf_.flags |= ggx ? gpu::kMaterialGgx : gpu::kMaterialBeckmann;
    leaf_.options |= ggx ? gpu::kOptionGgx : 0u;
    return *this;
  }
  PackedLeaf take() { return std::move(leaf_); }

 private:
  uint32_t texture(TextureIndex index, size_t row) {
    if (index == kNone) return gpu::kNoTexture;
    leaf_.textured |= 1u << row;
    leaf_.flags |= gpu::kMaterialTextured;
    return row_of_texture_[static_cast<size_t>(index)];
  }
  std::span<const uint32_t> row_of_texture_;
  PackedLeaf leaf_;
};

bool is_constant(const ColorInput& input, double value) {
  return input.texture == kNone && input.value == dvec3(value);
}
bool is_constant(const ScalarInput& input, double value) { return input.texture == kNone && input.value == value; }

// As in bsdf/microfacet.glsl and bsdf/rough_dielectric.glsl, where the reasons stand.
constexpr double kSmoothAlpha = 2e-5, kMinBending = 1e-5, kIndexMatched = 1e-6;

bool is_textured(const Roughness& r) { return r.alpha_u.texture != kNone || r.alpha_v.texture != kNone; }
double max_alpha(const Roughness& r) { return std::max(r.alpha_u.value, r.alpha_v.value); }
bool is_smooth(const Roughness& r) { return !is_textured(r) && max_alpha(r) < kSmoothAlpha; }
uint32_t roughness_flags(const Roughness& r) {
  const bool isotropic = r.alpha_u.texture == r.alpha_v.texture &&
                         (r.alpha_u.texture != kNone || r.alpha_u.value == r.alpha_v.value);
  return gpu::kMaterialSmooth | (isotropic ? 0u : gpu::kMaterialTangent) |
         (is_textured(r) ? gpu::kMaterialDelta : 0u);
}

struct LeafPacker {
  std::span<const uint32_t> row_of_texture;
  using Result = std::optional<PackedLeaf>;

  LeafWriter writer(uint32_t type, uint32_t flags) const { return {type, flags, row_of_texture}; }

  Result operator()(const DiffuseBsdf& b) const {
    PackedLeaf leaf = writer(gpu::kBsdfDiffuse, gpu::kMaterialSmooth).color(b.reflectance).take();
    leaf.scatters = !is_constant(b.reflectance, 0);
    return leaf;
  }
  Result operator()(const RoughDiffuseBsdf& b) const {
    return writer(gpu::kBsdfRoughDiffuse, gpu::kMaterialSmooth)
        .color(b.reflectance).pair(b.alpha, b.alpha).constants(b.use_fast_approx ? 1 : 0).take();
  }
  Result operator()(const ConductorBsdf& b) const {
    return writer(gpu::kBsdfConductor, gpu::kMaterialDelta)
        .color(b.eta).color(b.k).color(b.specular_reflectance).take();
  }
  Result operator()(const RoughConductorBsdf& b) const {
    if (is_smooth(b.roughness)) return (*this)(ConductorBsdf{b.eta, b.k, b.specular_reflectance});
    return writer(gpu::kBsdfRoughConductor, roughness_flags(b.roughness))
        .distribution(b.roughness.distribution)
        .color(b.eta).color(b.k).color(b.specular_reflectance)
        .pair(b.roughness.alpha_u, b.roughness.alpha_v).take();
  }
  Result operator()(const DielectricBsdf& b) const {
    const bool matched = std::abs(b.eta - 1) < kIndexMatched;
    if (matched && is_constant(b.specular_transmittance, 1)) return std::nullopt;
    return writer(gpu::kBsdfDielectric, gpu::kMaterialDelta)
        .color(b.specular_reflectance).color(b.specular_transmittance).interface(matched ? 1 : b.eta).take();
  }
  Result operator()(const ThinDielectricBsdf& b) const {
    return writer(gpu::kBsdfThinDielectric, gpu::kMaterialDelta | gpu::kMaterialNull)
        .color(b.specular_reflectance).color(b.specular_transmittance).interface(b.eta).take();
  }
  Result operator()(const RoughDielectricBsdf& b) const {
    if (is_smooth(b.roughness) || std::abs(b.eta - 1) < kIndexMatched)
      return (*this)(DielectricBsdf{b.eta, b.specular_reflectance, b.specular_transmittance});
    const bool straight = max_alpha(b.roughness) * std::abs(b.eta - 1) < kMinBending ||
                          max_alpha(b.roughness) * std::abs(1 / b.eta - 1) < kMinBending;
    return writer(gpu::kBsdfRoughDielectric,
                  roughness_flags(b.roughness) | (straight ? gpu::kMaterialDelta : 0u))
        .distribution(b.roughness.distribution)
        .color(b.specular_reflectance).color(b.specular_transmittance).interface(b.eta)
        .pair(b.roughness.alpha_u, b.roughness.alpha_v).take();
  }
  Result operator()(const PlasticBsdf& b) const {
    return writer(gpu::kBsdfPlastic, gpu::kMaterialSmooth | gpu::kMaterialDelta)
        .color(b.diffuse_reflectance).color(b.specular_reflectance)
        .constants((b.eta - 1) * (b.eta + 1), diffuse_fresnel_reflectance(1 / b.eta), 1 / (b.eta * b.eta),
                   b.nonlinear ? 1 : 0)
        .take();
  }
  Result operator()(const RoughPlasticBsdf& b) const {
    const double alpha = b.roughness.alpha_u.value;
    if (alpha < kSmoothAlpha)
      return (*this)(PlasticBsdf{b.eta, b.diffuse_reflectance, b.specular_reflectance, b.nonlinear});
    const RoughTransmittance table = rough_transmittance(b.roughness.distribution, alpha, b.eta);
    const double inside = b.keeps_light_inside ? 1 - table.internal_transmittance : table.internal_reflectance;
    LeafWriter leaf = writer(gpu::kBsdfRoughPlastic, gpu::kMaterialSmooth);
    leaf.distribution(b.roughness.distribution)
        .color(b.diffuse_reflectance).color(b.specular_reflectance)
        .constants((b.eta - 1) * (b.eta + 1), inside, 1 / (b.eta * b.eta), b.nonlinear ? 1 : 0)
        .constants(alpha);
    for (size_t i = 0; i < table.external.size(); i += 2)
      leaf.constants(table.external[i], table.external[i + 1],
                     i + 2 < table.external.size() ? table.external[i + 2] : table.external[i + 1]);
    return leaf.take();
  }
  Result operator()(const PrincipledBsdf& b) const {
    const uint32_t flags = gpu::kMaterialSmooth | gpu::kMaterialGgx |
                           (is_constant(b.anisotropic, 0) ? 0u : gpu::kMaterialTangent) |
                           (is_constant(b.spec_trans, 0) ? 0u : gpu::kMaterialTransmits) |
                           (is_constant(b.clearcoat, 0) ? 0u : gpu::kMaterialClearcoat);
    return writer(gpu::kBsdfPrincipled, flags)
        .color(b.base_color).quad(b.roughness, b.anisotropic, b.metallic, b.spec_trans)
        .quad(b.spec_tint, b.sheen, b.sheen_tint, b.flatness).pair(b.clearcoat, b.clearcoat_gloss)
        .interface(b.eta)
        .constants(b.diffuse_reflectance_sampling_rate, b.main_specular_sampling_rate, b.clearcoat_sampling_rate)
        .take();
  }
  Result operator()(const PrincipledThinBsdf& b) const {
    const uint32_t flags = gpu::kMaterialSmooth | gpu::kMaterialGgx |
                           (is_constant(b.anisotropic, 0) ? 0u : gpu::kMaterialTangent);
    return writer(gpu::kBsdfPrincipledThin, flags)
        .color(b.base_color).quad(b.roughness, b.anisotropic, b.spec_trans, b.eta)
        .quad(b.spec_tint, b.sheen, b.sheen_tint, b.flatness).pair(b.diff_trans, b.diff_trans)
        .constants(b.specular_reflectance_sampling_rate, b.specular_transmittance_sampling_rate,
                   b.diffuse_reflectance_sampling_rate, b.diffuse_transmittance_sampling_rate)
        .take();
  }
  Result operator()(const BlinnPhongBsdf& b) const {
    return writer(gpu::kBsdfBlinnPhong, gpu::kMaterialSmooth)
        .color(b.diffuse_reflectance).color(b.specular_reflectance)
        .pair(b.exponent, b.specular_weight.value_or(ScalarInput(0)))
        .constants(b.specular_weight ? 1 : 0).take();
  }
  Result operator()(const MicrofacetBsdf& b) const {
    return writer(gpu::kBsdfMicrofacet, gpu::kMaterialSmooth | gpu::kMaterialBeckmann)
        .color(b.kd).pair(b.alpha, b.alpha).interface(b.int_ior / b.ext_ior).take();
  }
  template <class Adapter>
  Result operator()(const Adapter&) const {
    CHECK(!"an adapter is no leaf");
    return std::nullopt;
  }
};

}  // namespace

std::optional<PackedLeaf> pack_leaf(const Bsdf& bsdf, std::span<const uint32_t> row_of_texture) {
  return std::visit(LeafPacker{row_of_texture}, bsdf.kind);
}

}  // namespace tachylite
