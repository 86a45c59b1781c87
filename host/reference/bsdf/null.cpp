#include "reference/bsdf/null.h"

namespace tachylite::reference {

std::optional<BsdfSample> sample_bsdf(const NullBsdf&, const ShadingPoint&, const dvec3& wo, Random&) {
  return BsdfSample{-wo, dvec3(1), 1, Scattering::kNull};
}

double pdf_bsdf(const NullBsdf&, const ShadingPoint&, const dvec3&, const dvec3&) {
  return 0;
}
dvec3 eval_bsdf(const NullBsdf&, const ShadingPoint&, const dvec3&, const dvec3&) {
  return dvec3(0);
}

}  // namespace tachylite::reference
