#pragma once

#include <array>

#include "scene/scene.h"
#include "shared/material.h"

namespace tachylite {

/// What light meets at the rough coat of a `roughplastic`, tabulated as Mitsuba 3 does.
struct RoughTransmittance {
  /// Share of the light from outside that gets through, for cos = i / (size - 1).
  std::array<double, gpu::kRoughTransmittanceSize> external{};
  /// Reflectance of the coat for diffuse light from inside.
  double internal_reflectance = 0;
  /// Share of the diffuse light from inside that gets out.
  double internal_transmittance = 0;
};

/// eta: inside over outside. Visible normals are integrated by a product of Gauss-Legendre rules.
RoughTransmittance rough_transmittance(MicrofacetDistribution distribution, double alpha, double eta);

/// Reflectance of a smooth interface for diffuse light that comes from the side of the index 1 towards the index eta.
double diffuse_fresnel_reflectance(double eta);

}  // namespace tachylite
