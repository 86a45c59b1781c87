#include "scene/parse_spectrum.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "scene/cie_1931.h"

namespace tachylite {
namespace {

double interpolate(const std::array<double, kCieCount>& table, double wavelength) {
  const double t = (wavelength - kCieFirst) / kCieStep;
  const size_t i = std::min(static_cast<size_t>(t), static_cast<size_t>(kCieCount - 2));
  return std::lerp(table[i], table[i + 1], t - static_cast<double>(i));
}

/// Linear between the samples, 0 outside.
double interpolate(const std::vector<double>& wavelengths, const std::vector<double>& values,
                   double wavelength) {
  if (wavelength < wavelengths.front() || wavelength > wavelengths.back()) return 0;
  const auto above = std::upper_bound(wavelengths.begin(), wavelengths.end(), wavelength);
  const size_t j = std::min(static_cast<size_t>(above - wavelengths.begin()), wavelengths.size() - 1);
  const size_t i = j - 1;
  return std::lerp(values[i], values[j], (wavelength - wavelengths[i]) / (wavelengths[j] - wavelengths[i]));
}

}  // namespace

glm::dvec3 xyz_to_rgb(const glm::dvec3& xyz) {
  return {3.240479 * xyz.x - 1.537150 * xyz.y - 0.498535 * xyz.z,
          -0.969256 * xyz.x + 1.875991 * xyz.y + 0.041556 * xyz.z,
          0.055648 * xyz.x - 0.204043 * xyz.y + 1.057311 * xyz.z};
}

glm::dvec3 spectrum_to_rgb(const std::vector<double>& wavelengths, const std::vector<double>& values,
                           ColorUse use) {
  CHECK_EQ(wavelengths.size(), values.size());
  CHECK(wavelengths.size() >= 2);
  // The rule, ends included and weights all equal, is Mitsuba's; its error of 1e-3 is part of what a scene
  // means.
  constexpr int kSteps = 1000;
  constexpr double kRange = kCieLast - kCieFirst;
  glm::dvec3 xyz{0};
  for (int i = 0; i < kSteps; ++i) {
    const double wavelength = kCieFirst + kRange * i / (kSteps - 1);
    double value = interpolate(wavelengths, values, wavelength);
    if (use != ColorUse::kEmission) value *= interpolate(kD65, wavelength) / kD65Normalization;
    xyz += value * glm::dvec3(interpolate(kCieX, wavelength), interpolate(kCieY, wavelength),
                              interpolate(kCieZ, wavelength));
  }
  const glm::dvec3 rgb = glm::max(xyz_to_rgb(xyz * (kRange / kSteps / kCieYIntegral)), glm::dvec3(0));
  return use == ColorUse::kReflectance ? glm::min(rgb, glm::dvec3(1)) : rgb;
}

}  // namespace tachylite
