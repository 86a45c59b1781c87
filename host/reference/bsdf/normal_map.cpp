#include "reference/bsdf/normal_map.h"

namespace tachylite::reference {
namespace {

/// The perturbed frame in local coordinates, and the shading point as seen from it.
struct Perturbed {
  Frame frame;
  ShadingPoint point;
};

Perturbed perturb(const ShadingPoint& point, const dvec3& wo, dvec3 n, bool flip_invalid_normals) {
  if (flip_invalid_normals && wo.z * glm::dot(wo, n) <= 0) n = {-n.x, -n.y, n.z};
  const Frame frame = frame_around(n, dvec3(1, 0, 0));
  return {frame,
          {point.materials, point.at, frame.to_local(point.n_g), frame.to_local(point.dp_du),
           frame.to_local(point.dp_dv)}};
}

Perturbed perturb(const NormalMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo) {
  const dvec3 rgb = eval_texture(point.materials.scene(), bsdf.normalmap, point.at);
  return perturb(point, wo, glm::normalize(2.0 * rgb - 1.0), bsdf.flip_invalid_normals);
}

Perturbed perturb(const BumpMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo) {
  const dvec2 slope = bsdf.scale * eval_texture_gradient(point.materials.scene(), bsdf.height, point.at);
  const dvec3 p_u(point.dp_du.x, point.dp_du.y, slope.x), p_v(point.dp_dv.x, point.dp_dv.y, slope.y);
  dvec3 n = glm::normalize(glm::cross(p_u, p_v));
  if (glm::dot(n, point.n_g) < 0) n = -n;
  return perturb(point, wo, n, bsdf.flip_invalid_normals);
}

/// Estevez et al. 2019, eq. 3 with the alpha of their eq. 4.
double shadowing(bool use, const Perturbed& perturbed, const dvec3& wi) {
  if (!use) return 1;
  const dvec3& n = perturbed.frame.n;
  const double alpha2 = std::min(0.125 * (sqr(n.x) + sqr(n.y)) / sqr(n.z), 1.0);
  return 2 / (1 + std::sqrt(1 + alpha2 * (sqr(wi.x) + sqr(wi.y)) / sqr(wi.z)));
}

bool sides_agree(const Perturbed& perturbed, const dvec3& w) {
  return w.z * glm::dot(w, perturbed.frame.n) > 0;
}

template <class Kind>
std::optional<BsdfSample> sample_perturbed(const Kind& bsdf, const ShadingPoint& point, const dvec3& wo,
                                           Random& random) {
  const Perturbed perturbed = perturb(bsdf, point, wo);
  auto sample = sample_bsdf(bsdf.child, perturbed.point, perturbed.frame.to_local(wo), random);
  if (!sample) return std::nullopt;
  if (sample->kind == Scattering::kNull) {  // goes straight on, whatever the frame
    sample->wi = -wo;
    return sample;
  }
  sample->wi = sample->kind == Scattering::kPane ? -wo : perturbed.frame.to_world(sample->wi);
  if (!sides_agree(perturbed, sample->wi)) return std::nullopt;
  sample->weight *= shadowing(bsdf.use_shadowing_function, perturbed, sample->wi);
  return sample;
}

template <class Kind>
double pdf_perturbed(const Kind& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  const Perturbed perturbed = perturb(bsdf, point, wo);
  if (!sides_agree(perturbed, wi)) return 0;
  return pdf_bsdf(bsdf.child, perturbed.point, perturbed.frame.to_local(wo), perturbed.frame.to_local(wi));
}

template <class Kind>
dvec3 eval_perturbed(const Kind& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  const Perturbed perturbed = perturb(bsdf, point, wo);
  if (!sides_agree(perturbed, wi)) return dvec3(0);
  return eval_bsdf(bsdf.child, perturbed.point, perturbed.frame.to_local(wo), perturbed.frame.to_local(wi)) *
         shadowing(bsdf.use_shadowing_function, perturbed, wi);
}

}  // namespace

std::optional<BsdfSample> sample_bsdf(const NormalMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random) {
  return sample_perturbed(bsdf, point, wo, random);
}
double pdf_bsdf(const NormalMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  return pdf_perturbed(bsdf, point, wo, wi);
}
dvec3 eval_bsdf(const NormalMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  return eval_perturbed(bsdf, point, wo, wi);
}

std::optional<BsdfSample> sample_bsdf(const BumpMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo,
                                      Random& random) {
  return sample_perturbed(bsdf, point, wo, random);
}
double pdf_bsdf(const BumpMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  return pdf_perturbed(bsdf, point, wo, wi);
}
dvec3 eval_bsdf(const BumpMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo, const dvec3& wi) {
  return eval_perturbed(bsdf, point, wo, wi);
}

dvec3 null_transmission(const NormalMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo) {
  return null_transmission(bsdf.child, point, wo);
}
dvec3 null_transmission(const BumpMapBsdf& bsdf, const ShadingPoint& point, const dvec3& wo) {
  return null_transmission(bsdf.child, point, wo);
}

}  // namespace tachylite::reference
