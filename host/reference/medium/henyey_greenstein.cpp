#include "reference/medium/henyey_greenstein.h"

namespace tachylite::reference {

double eval_henyey_greenstein(double g, double cos_theta) {
  const double q = 1 + g * g - 2 * g * cos_theta;
  return (1 - g * g) / (4 * kPi * q * std::sqrt(q));
}

double sample_henyey_greenstein(double g, double u) {
  if (std::abs(g) < 1e-4) {  // the other form cancels; this one is exact to g^2
    const double c = 2 * u - 1;
    return std::clamp(c + 1.5 * g * (1 - c * c), -1.0, 1.0);
  }
  const double s = (1 - g * g) / (1 - g + 2 * g * u);
  return std::clamp((1 + g * g - s * s) / (2 * g), -1.0, 1.0);
}

}  // namespace tachylite::reference
