#include "reference/bsdf/dielectric.h"

#include "reference/bsdf/fresnel.h"

namespace tachylite::reference {

bool is_index_matched(const DielectricBsdf& bsdf) {
  const ColorInput& tint = bsdf.specular_transmittance;
  return std::abs(bsdf.eta - 1) < 1e-6 && tint.texture == kNone && tint.value == dvec3(1);
}

std::optional<BsdfSample> sample_bsdf(const DielectricBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random) {
  if (is_index_matched(bsdf)) return BsdfSample{-wo, dvec3(1), 1, Scattering::kNull};
  const DielectricBoundary boundary = dielectric_boundary(wo.z, bsdf.eta);
  const double f = boundary.reflectance;
  if (random.uniform() < f) {
    return BsdfSample{{-wo.x, -wo.y, wo.z}, point.color(bsdf.specular_reflectance), f, Scattering::kDelta};
  }
  const double eta = boundary.eta_ti;
  return BsdfSample{{-wo.x / eta, -wo.y / eta, boundary.cos_t},
                    point.color(bsdf.specular_transmittance) / sqr(eta),
                    1 - f,
                    Scattering::kDelta,
                    eta};
}

double pdf_bsdf(const DielectricBsdf&, const ShadingPoint&, const dvec3&, const dvec3&) {
  return 0;
}
dvec3 eval_bsdf(const DielectricBsdf&, const ShadingPoint&, const dvec3&, const dvec3&) {
  return dvec3(0);
}

}  // namespace tachylite::reference
