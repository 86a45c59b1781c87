#include "reference/medium/homogeneous.h"

namespace tachylite::reference {

ChannelChoice choose_channel(const dvec3& weights, Random& random) {
  const dvec3 p = weights / (weights.x + weights.y + weights.z);
  const double u = random.uniform();
  int channel = u < p.x ? 0 : u < p.x + p.y ? 1 : 2;
  while (p[channel] == 0) channel = (channel + 2) % 3;  // u fell behind the last one by rounding
  return {channel, p};
}

std::optional<double> sample_homogeneous(const HomogeneousMedium& medium, double t_max, dvec3& throughput,
                                         Random& random) {
  const auto [channel, p] = choose_channel(throughput, random);
  const double sigma = medium.sigma_t[channel];
  const double t = sigma > 0 ? -std::log1p(-random.uniform()) / sigma : kInfinity;

  // The common factor exp(-sigma_min t) of all channels that matter cancels, and without it nothing
  // underflows.
  double sigma_min = kInfinity;
  for (int c = 0; c < 3; ++c) {
    if (p[c] > 0) sigma_min = std::min(sigma_min, medium.sigma_t[c]);
  }
  const bool collides = t < t_max;
  const double flown = collides ? t : t_max;
  dvec3 factor(0);
  double density = 0;
  for (int c = 0; c < 3; ++c) {
    if (!(p[c] > 0)) continue;
    const double excess = medium.sigma_t[c] - sigma_min;
    const double e = excess > 0 ? std::exp(-excess * flown) : 1;
    factor[c] = collides ? medium.albedo[c] * medium.sigma_t[c] * e : e;
    density += p[c] * (collides ? medium.sigma_t[c] * e : e);
  }
  throughput *= factor / density;
  return collides ? std::optional(t) : std::nullopt;
}

}  // namespace tachylite::reference
