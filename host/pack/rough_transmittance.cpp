#include "pack/rough_transmittance.h"

#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "base/parallel.h"
#include "base/pi.h"

namespace tachylite {
namespace {

struct Rule {
  std::vector<double> nodes, weights;  // on [0, 1]
  std::vector<double> slopes;          // erf^-1 of the nodes
};

/// The slope x with integral_-inf^x max(cot - s, 0) exp(-s^2) ds = u times the whole; by bisection.
double visible_slope(double cot, double u) {
  const auto cdf = [cot](double x) { return 0.5 * std::sqrt(kPi) * cot * std::erfc(-x) + 0.5 * std::exp(-x * x); };
  double low = -6, high = std::min(cot, 6.0);
  const double target = u * cdf(high);
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (cdf(middle) < target ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Gauss-Legendre on [0, 1]: Newton's method on the Legendre polynomial (Press et al. 2007, "Numerical Recipes",
/// section 4.6.1).
Rule gauss_legendre(int n) {
  Rule rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), derivative = 1;
    for (int step = 0; step < 20; ++step) {
      double p = 1, before = 0;
      for (int k = 1; k <= n; ++k) {
        const double before_that = before;
        before = p;
        p = ((2 * k - 1) * x * before - (k - 1) * before_that) / k;
      }
      derivative = n * (x * p - before) / (x * x - 1);
      x -= p / derivative;
    }
    rule.nodes.push_back(0.5 * (1 - x));
    rule.weights.push_back(1 / ((1 - x * x) * derivative * derivative));
    rule.slopes.push_back(visible_slope(1e10, 0.5 * (1 + rule.nodes.back())));
  }
  return rule;
}

double fresnel(double cos_i, double eta) {
  const double cos_t2 = 1 - (1 - cos_i * cos_i) / (eta * eta);
  if (cos_t2 <= 0) return 1;
  const double cos_t = std::sqrt(cos_t2);
  const double s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  const double p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  return 0.5 * (s * s + p * p);
}

double masking(MicrofacetDistribution distribution, double alpha, const dvec3& w) {
  const double tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
  if (tan2 == 0) return 1;
  if (distribution == MicrofacetDistribution::kGgx) return 2 / (1 + std::sqrt(1 + alpha * alpha * tan2));
  const double a = 1 / (alpha * std::sqrt(tan2));
  const double lambda = 0.5 * (std::exp(-a * a) / (a * std::sqrt(kPi)) - std::erfc(a));
  return 1 / (1 + lambda);
}

/// The mean of f(m) over the normals visible from wo = (sqrt(1 - mu^2), 0, mu).
double mean_over_visible_normals(MicrofacetDistribution distribution, double alpha, double mu, const Rule& rule,
                                 const std::function<double(const dvec3&)>& f) {
  const size_t n = rule.nodes.size();
  const dvec3 stretched = glm::normalize(dvec3(alpha * std::sqrt(1 - mu * mu), 0, mu));
  double sum = 0;
  if (distribution == MicrofacetDistribution::kGgx) {
    // Spherical caps: Dupuy and Benyoub 2023.
    for (size_t i = 0; i < n; ++i) {
      const double z = 1 - rule.nodes[i] * (1 + stretched.z), r = std::sqrt(std::max(0.0, 1 - z * z));
      for (size_t j = 0; j < n; ++j) {
        const double phi = kPi * rule.nodes[j];  // half of the circle: f is even in y
        const dvec3 h = dvec3(r * std::cos(phi), r * std::sin(phi), z) + stretched;
        sum += rule.weights[i] * rule.weights[j] * f(glm::normalize(dvec3(alpha * h.x, alpha * h.y, h.z)));
      }
    }
    return sum;
  }
  const double cot = stretched.x > 0 ? stretched.z / stretched.x : 1e10;
  for (size_t i = 0; i < n; ++i) {
    const double slope_x = visible_slope(cot, rule.nodes[i]);
    for (size_t j = 0; j < n; ++j) {
      const double slope_y = rule.slopes[j];
      sum += rule.weights[i] * rule.weights[j] * f(glm::normalize(dvec3(-alpha * slope_x, -alpha * slope_y, 1)));
    }
  }
  return sum;
}

/// Share of the light along wo that leaves by reflection at a rough interface.
double reflectance(MicrofacetDistribution distribution, double alpha, double eta, double mu, const Rule& rule) {
  const dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  return mean_over_visible_normals(distribution, alpha, mu, rule, [&](const dvec3& m) {
    const double c = glm::dot(wo, m);
    const dvec3 wi = 2 * c * m - wo;
    return wi.z > 0 ? fresnel(c, eta) * masking(distribution, alpha, wi) : 0.0;
  });
}

/// ... by refraction.
double transmittance(MicrofacetDistribution distribution, double alpha, double eta, double mu, const Rule& rule) {
  const dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  return mean_over_visible_normals(distribution, alpha, mu, rule, [&](const dvec3& m) {
    const double c = glm::dot(wo, m), cos_t2 = 1 - (1 - c * c) / (eta * eta);
    if (c <= 0 || cos_t2 <= 0) return 0.0;
    const dvec3 wi = (c / eta - std::sqrt(cos_t2)) * m - wo / eta;
    return wi.z < 0 ? (1 - fresnel(c, eta)) * masking(distribution, alpha, wi) : 0.0;
  });
}

}  // namespace

RoughTransmittance rough_transmittance(MicrofacetDistribution distribution, double alpha, double eta) {
  RoughTransmittance result;
  const Rule rule = gauss_legendre(32), fine = gauss_legendre(64);
  const Rule& inward = eta > 1 ? rule : fine;  // the side with total reflection has a kink
  const Rule& outward = eta > 1 ? fine : rule;
  const size_t count = result.external.size();
  std::vector<double> internal(count), averaged(rule.nodes.size());
  parallel_for_each(count, [&](size_t i) {
    const double mu = std::max(1e-6, static_cast<double>(i) / static_cast<double>(count - 1));
    result.external[i] = transmittance(distribution, alpha, eta, mu, inward);
    internal[i] = reflectance(distribution, alpha, 1 / eta, mu, outward) * mu;
  });
  // 2 integral R mu dmu by Mitsuba's rule, the plain mean of the values at both ends and in between: its error is
  // part of what a scene means.
  result.internal_reflectance = 2 * std::accumulate(internal.begin(), internal.end(), 0.0) / static_cast<double>(count);
  // By reciprocity, integral T_internal(mu) mu dmu = integral T_external(mu) mu dmu / eta^2.
  parallel_for_each(averaged.size(), [&](size_t i) {
    const double mu = rule.nodes[i];
    averaged[i] = rule.weights[i] * 2 * mu * transmittance(distribution, alpha, eta, mu, inward) / (eta * eta);
  });
  result.internal_transmittance = std::accumulate(averaged.begin(), averaged.end(), 0.0);
  return result;
}

double diffuse_fresnel_reflectance(double eta) {
  // Where Mitsuba's fit (Egan and Hilgeman 1973) is wrong by more than a render could hide, it is what scenes mean.
  if (eta < 0.5) return -1.4399 * eta * eta + 0.7099 * eta + 0.6681 + 0.0636 / eta;
  // 2 integral F(c) c dc; below eta = 1 all of the light beyond the critical angle comes back.
  const double c0 = eta < 1 ? std::sqrt(1 - eta * eta) : 0.0;
  static const Rule rule = gauss_legendre(64);
  double sum = c0 * c0;
  for (size_t i = 0; i < rule.nodes.size(); ++i) {
    const double x = rule.nodes[i], c = c0 + (1 - c0) * x * x;  // F has a root at c0
    sum += rule.weights[i] * 2 * (1 - c0) * x * 2 * c * fresnel(c, eta);
  }
  return sum;
}

}  // namespace tachylite
