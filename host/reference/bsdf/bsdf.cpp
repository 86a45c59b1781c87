#include "reference/bsdf/bsdf.h"

#include "reference/bsdf/blend.h"
#include "reference/bsdf/blinn_phong.h"
#include "reference/bsdf/conductor.h"
#include "reference/bsdf/dielectric.h"
#include "reference/bsdf/diffuse.h"
#include "reference/bsdf/mask.h"
#include "reference/bsdf/microfacet_material.h"
#include "reference/bsdf/normal_map.h"
#include "reference/bsdf/null.h"
#include "reference/bsdf/paper.h"
#include "reference/bsdf/plastic.h"
#include "reference/bsdf/principled.h"
#include "reference/bsdf/principled_thin.h"
#include "reference/bsdf/rough_conductor.h"
#include "reference/bsdf/rough_dielectric.h"
#include "reference/bsdf/rough_diffuse.h"
#include "reference/bsdf/rough_plastic.h"
#include "reference/bsdf/thin_dielectric.h"
#include "reference/bsdf/two_sided.h"

namespace tachylite::reference {
namespace {

// What a kind has when its header says nothing else.
template <class Kind>
bool is_all_delta(const Kind&) {
  return false;
}
template <class Kind>
dvec3 null_transmission(const Kind&, const ShadingPoint&, const dvec3&) {
  return dvec3(0);
}
const BsdfKind& kind_of(const Scene& scene, BsdfIndex bsdf) {
  return scene.bsdfs[static_cast<size_t>(bsdf)].kind;
}
const BsdfKind& kind_of(const ShadingPoint& point, BsdfIndex bsdf) {
  return kind_of(point.materials.scene(), bsdf);
}

}  // namespace

Materials::Materials(const Scene& scene) : scene_(scene) {
  for (const Bsdf& bsdf : scene.bsdfs) {
    const auto* rough_plastic = std::get_if<RoughPlasticBsdf>(&bsdf.kind);
    if (rough_plastic) rough_plastics_.emplace_back(rough_plastic, make_rough_plastic_tables(*rough_plastic));
  }
}

const RoughPlasticTables& Materials::rough_plastic(const RoughPlasticBsdf& bsdf) const {
  const auto found = std::find_if(rough_plastics_.begin(), rough_plastics_.end(),
                                  [&](const auto& entry) { return entry.first == &bsdf; });
  return found->second;
}

ShadingPoint shading_point(const Materials& materials, const SurfacePoint& surface) {
  const Frame& frame = surface.frame;
  return {materials, surface.at, frame.to_local(surface.n_g), frame.to_local(surface.dp_du),
          frame.to_local(surface.dp_dv)};
}

std::optional<BsdfSample> sample_bsdf(BsdfIndex bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random) {
  return std::visit([&](const auto& kind) { return sample_bsdf(kind, point, wo, random); },
                    kind_of(point, bsdf));
}

double pdf_bsdf(BsdfIndex bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  return std::visit([&](const auto& kind) { return pdf_bsdf(kind, point, wo, wi); }, kind_of(point, bsdf));
}

dvec3 eval_bsdf(BsdfIndex bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  return std::visit([&](const auto& kind) { return eval_bsdf(kind, point, wo, wi); }, kind_of(point, bsdf));
}

dvec3 null_transmission(BsdfIndex bsdf, const ShadingPoint& point, const dvec3& wo) {
  return std::visit([&](const auto& kind) { return null_transmission(kind, point, wo); },
                    kind_of(point, bsdf));
}

bool has_smooth_lobe(const Scene& scene, BsdfIndex bsdf) {
  const BsdfKind& kind = kind_of(scene, bsdf);
  if (const auto* b = std::get_if<TwoSidedBsdf>(&kind)) {
    return has_smooth_lobe(scene, b->front) || has_smooth_lobe(scene, b->back);
  }
  if (const auto* b = std::get_if<BlendBsdf>(&kind)) {
    return has_smooth_lobe(scene, b->first) || has_smooth_lobe(scene, b->second);
  }
  if (const auto* b = std::get_if<MaskBsdf>(&kind)) return has_smooth_lobe(scene, b->child);
  if (const auto* b = std::get_if<NormalMapBsdf>(&kind)) return has_smooth_lobe(scene, b->child);
  if (const auto* b = std::get_if<BumpMapBsdf>(&kind)) return has_smooth_lobe(scene, b->child);
  return std::visit([](const auto& b) { return !is_all_delta(b); }, kind);
}

}  // namespace tachylite::reference
