#include "reference/bsdf/thin_dielectric.h"

#include "reference/bsdf/fresnel.h"

namespace tachylite::reference {
namespace {

double sheet_reflectance(const ThinDielectricBsdf& bsdf, const dvec3& wo) {
  const double r = fresnel_dielectric(std::abs(wo.z), bsdf.eta);
  return 2 * r / (1 + r);
}

}  // namespace

std::optional<BsdfSample> sample_bsdf(const ThinDielectricBsdf& bsdf, const ShadingPoint& point,
                                      const dvec3& wo, Random& random) {
  const double r = sheet_reflectance(bsdf, wo);
  if (random.uniform() < r) {
    return BsdfSample{{-wo.x, -wo.y, wo.z}, point.color(bsdf.specular_reflectance), r, Scattering::kDelta};
  }
  return BsdfSample{-wo, point.color(bsdf.specular_transmittance), 1 - r, Scattering::kPane};
}

double pdf_bsdf(const ThinDielectricBsdf&, const ShadingPoint&, const dvec3&, const dvec3&) {
  return 0;
}
dvec3 eval_bsdf(const ThinDielectricBsdf&, const ShadingPoint&, const dvec3&, const dvec3&) {
  return dvec3(0);
}

dvec3 null_transmission(const ThinDielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo) {
  return point.color(bsdf.specular_transmittance) * (1 - sheet_reflectance(bsdf, wo));
}

}  // namespace tachylite::reference
