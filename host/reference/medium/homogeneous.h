#pragma once

#include <optional>

#include "reference/random.h"
#include "scene/scene.h"

namespace tachylite::reference {

/// Distance of the next collision within t_max, or none; updates the throughput as Media::sample_free_flight
/// says.
std::optional<double> sample_homogeneous(const HomogeneousMedium& medium, double t_max, dvec3& throughput,
                                         Random& random);
inline dvec3 transmittance_homogeneous(const HomogeneousMedium& medium, double distance) {
  dvec3 result;
  for (int c = 0; c < 3; ++c) result[c] = medium.sigma_t[c] > 0 ? std::exp(-medium.sigma_t[c] * distance) : 1;
  return result;
}

/// Index of a channel, with probabilities proportional to `weights`; and those probabilities.
struct ChannelChoice {
  int channel;
  dvec3 probability;
};
ChannelChoice choose_channel(const dvec3& weights, Random& random);

}  // namespace tachylite::reference
