#include "reference/bsdf/albedo.h"

#include <algorithm>

#include "reference/bsdf/fresnel.h"

namespace tachylite::reference {
namespace {

struct Albedo {
  const ShadingPoint& point;
  bool from_front;

  dvec3 of(BsdfIndex bsdf) const {
    return std::visit(*this, point.materials.scene().bsdfs[static_cast<size_t>(bsdf)].kind);
  }
  template <class Metal>
  dvec3 of_metal(const Metal& metal) const {
    return point.color(metal.specular_reflectance) *
           fresnel_conductor(1, point.color(metal.eta), point.color(metal.k));
  }
  double part(const ScalarInput& input) const { return std::clamp(point.scalar(input), 0.0, 1.0); }

  dvec3 operator()(const DiffuseBsdf& b) const { return point.color(b.reflectance); }
  dvec3 operator()(const RoughDiffuseBsdf& b) const { return point.color(b.reflectance); }
  dvec3 operator()(const ConductorBsdf& b) const { return of_metal(b); }
  dvec3 operator()(const RoughConductorBsdf& b) const { return of_metal(b); }
  dvec3 operator()(const DielectricBsdf&) const { return dvec3(1); }
  dvec3 operator()(const ThinDielectricBsdf&) const { return dvec3(1); }
  dvec3 operator()(const RoughDielectricBsdf&) const { return dvec3(1); }
  dvec3 operator()(const PlasticBsdf& b) const { return point.color(b.diffuse_reflectance); }
  dvec3 operator()(const RoughPlasticBsdf& b) const { return point.color(b.diffuse_reflectance); }
  dvec3 operator()(const PrincipledBsdf& b) const { return point.color(b.base_color); }
  dvec3 operator()(const PrincipledThinBsdf& b) const { return point.color(b.base_color); }
  dvec3 operator()(const BlinnPhongBsdf& b) const {
    return (b.specular_weight ? 1 - part(*b.specular_weight) : 1) * point.color(b.diffuse_reflectance);
  }
  dvec3 operator()(const MicrofacetBsdf& b) const { return point.color(b.kd); }
  dvec3 operator()(const PaperBsdf& b) const { return (1 - part(b.transparency)) * point.color(b.reflectance); }
  dvec3 operator()(const NullBsdf&) const { return dvec3(0); }
  dvec3 operator()(const TwoSidedBsdf& b) const { 
    return Albedo{point, true}.of(from_front ? b.front : b.back);  // whose viewer it has mirrored to the front
  }
  dvec3 operator()(const MaskBsdf& b) const { return part(b.opacity) * of(b.child); }
  dvec3 operator()(const BlendBsdf& b) const {
    const double w = part(b.weight);
    return (1 - w) * of(b.first) + w * of(b.second);
  }
  dvec3 operator()(const NormalMapBsdf& b) const { return of(b.child); }
  dvec3 operator()(const BumpMapBsdf& b) const { return of(b.child); }
};

}  // namespace

dvec3 albedo_bsdf(BsdfIndex bsdf, const ShadingPoint& point, bool from_front) {
  return glm::clamp(Albedo{point, from_front}.of(bsdf), 0.0, 1.0);
}

}  // namespace tachylite::reference
