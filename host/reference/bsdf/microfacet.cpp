#include "reference/bsdf/microfacet.h"

namespace tachylite::reference {
namespace {

/// x in [low, high] with cdf(x) = target, by bisection to the last bits.
template <class Cdf>
double invert_cdf(const Cdf& cdf, double low, double high, double target) {
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (cdf(middle) < target ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

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

/// The visible part of the upper unit hemisphere is a half disk and a half ellipse, seen along the stretched
/// w.
dvec3 Microfacets::sample_ggx(const dvec3& w, const dvec2& u) const {
  const Frame frame = frame_around(w, dvec3(0, 0, 1));
  const dvec2 disk = sample_disk(u);
  const double blend = 0.5 * (1 + w.z);
  const double up = lerp(std::sqrt(std::max(0.0, 1 - sqr(disk.y))), disk.x, blend);
  const double out = std::sqrt(std::max(0.0, 1 - sqr(disk.y) - sqr(up)));
  return frame.to_world({up, disk.y, out});
}

/// Slopes of a surface of unit roughness: across the plane of w they are gaussian, in it their density is
/// proportional to (cos - x sin) exp(-x^2) up to x = cot, whose integral is elementary.
dvec3 Microfacets::sample_beckmann(const dvec3& w, const dvec2& u) const {
  const double cosine = w.z, sine = std::hypot(w.x, w.y);
  const auto visible = [&](double x) {
    return 0.5 * (cosine * (1 + std::erf(x)) + sine * std::exp(-x * x) / std::sqrt(kPi));
  };
  constexpr double kEnd = 6;  // erfc(6) = 2e-17
  const double end = sine * kEnd > cosine ? cosine / sine : kEnd;
  const double x = invert_cdf(visible, -kEnd, end, u.x * visible(end));
  const double y = invert_cdf([](double t) { return 0.5 * (1 + std::erf(t)); }, -kEnd, kEnd, u.y);
  const dvec2 e = sine > 0 ? dvec2(w.x, w.y) / sine : dvec2(1, 0);
  return {-(e.x * x - e.y * y), -(e.y * x + e.x * y), 1};
}

dvec3 Microfacets::sample(const dvec3& w_either, const dvec2& u) const {
  const dvec3 w = w_either.z < 0 ? -w_either : w_either;
  // Stretch to unit roughness, sample there, and stretch the normal back.
  const dvec3 stretched = glm::normalize(dvec3(alpha_u_ * w.x, alpha_v_ * w.y, w.z));
  const dvec3 m = distribution_ == MicrofacetDistribution::kGgx ? sample_ggx(stretched, u)
                                                                : sample_beckmann(stretched, u);
  return glm::normalize(dvec3(alpha_u_ * m.x, alpha_v_ * m.y, std::max(m.z, 1e-300)));
}

double Microfacets::pdf(const dvec3& w, const dvec3& m) const {
  const double cos_m = glm::dot(w, m) * (w.z < 0 ? -1 : 1);
  if (!(cos_m > 0) || w.z == 0) return 0;
  return d(m) * g1(w, m) * cos_m / std::abs(w.z);
}

}  // namespace tachylite::reference
