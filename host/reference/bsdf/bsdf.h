#pragma once

// Materials. All directions are unit vectors in the local shading frame (z along the shading normal),
// pointing away from the surface: wo to the viewer, wi to the light. (Mitsuba's plugins call these wi and
// wo.)
//   sample_bsdf   a direction wi with weight = f |cos wi| / pdf of *all* smooth lobes of the material
//   together, or
//                 of one delta lobe (then weight = f / probability, and pdf is that probability)
//   pdf_bsdf      density of sample_bsdf w.r.t. solid angle of wi, smooth lobes only (it integrates to the
//                 probability of choosing one, less what is sampled below the horizon)
//   eval_bsdf     f |cos wi| of the smooth lobes
// Radiance is transported: crossing into relative index eta scales it by 1/eta^2. BSDFs go by the shading
// frame only. A material of kind X has its overloads in bsdf/x.h; here are the switch over kinds, and what is
// common.

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "reference/geometry.h"
#include "scene/scene.h"

namespace tachylite::reference {

/// What roughplastic needs beside its formulas; see bsdf/rough_plastic.h.
struct RoughPlasticTables {
  std::array<double, 64> transmittance{};  // T at mu = i / 63
  double internal_reflectance = 0;
};

/// The materials of a scene and what is computed from them once.
class Materials {
 public:
  explicit Materials(const Scene& scene);
  const Scene& scene() const { return scene_; }
  const RoughPlasticTables& rough_plastic(const RoughPlasticBsdf& bsdf) const;

 private:
  const Scene& scene_;
  std::vector<std::pair<const RoughPlasticBsdf*, RoughPlasticTables>> rough_plastics_;
};

/// Where a material is evaluated. The derivatives of the surface are in local coordinates.
struct ShadingPoint {
  const Materials& materials;
  const TextureCoordinates& at;
  dvec3 n_g, dp_du, dp_dv;

  dvec3 color(const ColorInput& input) const { return eval_color(materials.scene(), input, at); }
  double scalar(const ScalarInput& input) const { return eval_scalar(materials.scene(), input, at); }
};
ShadingPoint shading_point(const Materials& materials, const SurfacePoint& surface);

/// kNull: straight through, wi = -wo, where there is nothing. kPane: straight through thin glass, which differs from
/// kNull only under normal and bump maps.
enum class Scattering { kSmooth, kDelta, kNull, kPane };
inline bool goes_straight(Scattering kind) { return kind == Scattering::kNull || kind == Scattering::kPane; }
struct BsdfSample {
  dvec3 wi{0};
  dvec3 weight{0};
  double pdf = 0;
  Scattering kind = Scattering::kSmooth;
  double eta = 1;  // relative index of the side that wi is on to that of wo
};

/// Nothing when the sample is lost (below the horizon, absorbed): its contribution is 0.
std::optional<BsdfSample> sample_bsdf(BsdfIndex bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random);
double pdf_bsdf(BsdfIndex bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);
dvec3 eval_bsdf(BsdfIndex bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi);

/// Fraction of light that passes straight through, for shadow rays of the volumetric integrators.
dvec3 null_transmission(BsdfIndex bsdf, const ShadingPoint& point, const dvec3& wo);
/// False when all lobes are delta or null: light sampling is pointless then.
bool has_smooth_lobe(const Scene& scene, BsdfIndex bsdf);

/// Ends sample_bsdf of a material whose lobes are all smooth: wi was sampled with the density pdf_bsdf.
template <class Kind>
std::optional<BsdfSample> finish_sample(const Kind& bsdf, const ShadingPoint& point, const dvec3& wo,
                                        const dvec3& wi, double eta = 1) {
  const double pdf = pdf_bsdf(bsdf, point, wo, wi);
  if (!(pdf > 0)) return std::nullopt;
  return BsdfSample{wi, eval_bsdf(bsdf, point, wo, wi) / pdf, pdf, Scattering::kSmooth, eta};
}

}  // namespace tachylite::reference
