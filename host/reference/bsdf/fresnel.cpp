#include "reference/bsdf/fresnel.h"

namespace tachylite::reference {

DielectricBoundary dielectric_boundary(double cos_o, double eta) {
  DielectricBoundary result;
  result.eta_ti = cos_o >= 0 ? eta : 1 / eta;
  const double e = result.eta_ti, c = std::abs(cos_o);
  // cos_t^2 = 1 - (1 - c^2) / e^2, in a form that is exact for e -> 1.
  const double g2 = (e - 1) * (e + 1) + c * c;  // (e cos_t)^2
  if (!(g2 > 0)) return result;
  const double g = std::sqrt(g2);
  const double r_s = (c - g) / (c + g);                  // (c - e cos_t) / (c + e cos_t)
  const double r_p = (e * e * c - g) / (e * e * c + g);  // (e c - cos_t) / (e c + cos_t)
  result.reflectance = 0.5 * (r_s * r_s + r_p * r_p);
  result.cos_t = std::copysign(g / e, -cos_o);
  return result;
}

dvec3 fresnel_conductor(double cos_o, const dvec3& eta, const dvec3& k) {
  const double c = std::min(std::abs(cos_o), 1.0), c2 = c * c, s2 = 1 - c2;
  dvec3 result;
  for (int i = 0; i < 3; ++i) {
    const double t0 = sqr(eta[i]) - sqr(k[i]) - s2;
    const double a2b2 = std::sqrt(sqr(t0) + 4 * sqr(eta[i] * k[i]));
    const double a = std::sqrt(std::max(0.0, 0.5 * (a2b2 + t0)));
    const double r_s = (a2b2 + c2 - 2 * a * c) / (a2b2 + c2 + 2 * a * c);
    const double u = a2b2 * c2 + sqr(s2), v = 2 * a * c * s2;
    const double r_p = u + v > 0 ? r_s * (u - v) / (u + v) : r_s;
    result[i] = 0.5 * (r_s + r_p);
  }
  return result;
}

double fresnel_diffuse_reflectance(double eta) {
  const double i = 1 / eta;
  if (eta < 1) return -1.4399 * eta * eta + 0.7099 * eta + 0.6681 + 0.0636 * i;
  return 0.919317 + i * (-3.4793 + i * (6.75335 + i * (-7.80989 + i * (4.98554 - 1.36881 * i))));
}

}  // namespace tachylite::reference
