#include "reference/bsdf/microfacet.h"

namespace tachylite::reference {

double Microfacets::ggx_d(const dvec3& m) const {
  if (m.z <= 0) return 0;
  const double q = sqr(m.x / alpha_u_) + sqr(m.y / alpha_v_) + sqr(m.z);
  return 1 / (kPi * alpha_u_ * alpha_v_ * sqr(q));
}

double Microfacets::beckmann_d(const dvec3& m) const {
  if (m.z <= 0) return 0;
  const double q = (sqr(m.x / alpha_u_) + sqr(m.y / alpha_v_)) / sqr(m.z);
  return std::exp(-q) / (kPi * alpha_u_ * alpha_v_ * sqr(sqr(m.z)));
}

double Microfacets::ggx_lambda(const dvec3& w) const {
  const double tan2 = (sqr(alpha_u_ * w.x) + sqr(alpha_v_ * w.y)) / sqr(w.z);
  return 0.5 * tan2 / (1 + std::sqrt(1 + tan2));  // = (sqrt(1 + tan2) - 1) / 2
}

double Microfacets::beckmann_lambda(const dvec3& w) const {
  const double length = std::hypot(alpha_u_ * w.x, alpha_v_ * w.y);
  if (length == 0) return 0;
  const double a = std::abs(w.z) / length;
  if (a > 20) return 0;  // exp(-400)
  return 0.5 * (std::exp(-a * a) / (a * std::sqrt(kPi)) - std::erfc(a));
}

double Microfacets::g1(const dvec3& w, const dvec3& m) const {
  if (!(glm::dot(w, m) * w.z > 0)) return 0;
  return 1 / (1 + (distribution_ == MicrofacetDistribution::kGgx ? ggx_lambda(w) : beckmann_lambda(w)));
}

dvec3 Microfacets::sample(const dvec3& w_either, const dvec2& u) const {
  const dvec3 w = w_either.z < 0 ? -w_either : w_either;
  const Frame frame = frame_around(glm::normalize(dvec3(alpha_u_ * w.x, alpha_v_ * w.y, w.z)), dvec3(0, 0, 1));
  // The visible part of the upper unit hemisphere is a half disk and a half ellipse, seen along the stretched w.
  const dvec2 disk = sample_disk(u);
  const double blend = 0.5 * (1 + frame.n.z);
  const double up = lerp(std::sqrt(std::max(0.0, 1 - sqr(disk.y))), disk.x, blend);
  const double out = std::sqrt(std::max(0.0, 1 - sqr(disk.y) - sqr(up)));
  const dvec3 m = frame.to_world({up, disk.y, out});
  return glm::normalize(dvec3(alpha_u_ * m.x, alpha_v_ * m.y, std::max(m.z, 1e-300)));
}

double Microfacets::pdf(const dvec3& w, const dvec3& m) const {
  const double cos_m = glm::dot(w, m) * (w.z < 0 ? -1 : 1);
  if (!(cos_m > 0) || w.z == 0) return 0;
  return ggx_d(m) * cos_m / (std::abs(w.z) * (1 + ggx_lambda(w)));
}

}  // namespace tachylite::reference
