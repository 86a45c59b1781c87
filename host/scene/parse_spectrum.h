#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace tachylite {

/// What a colour is used for; decides how spectra become linear Rec.709 and which values are allowed.
enum class ColorUse {
  kReflectance,  // [0, 1]
  kIor,          // eta and k: [0, inf)
  kEmission      // radiance, intensity...: [0, inf)
};

/// A spectrum that is linear between samples (wavelengths [nm], ascending) and 0 outside of them, as linear
/// Rec.709. All but emission is lit by D65, so that the constant spectrum 1 is white.
/// Colours outside of the allowed range are clamped to it.
glm::dvec3 spectrum_to_rgb(const std::vector<double>& wavelengths, const std::vector<double>& values,
                           ColorUse use);

/// CIE XYZ to linear Rec.709 (white D65).
glm::dvec3 xyz_to_rgb(const glm::dvec3& xyz);

}  // namespace tachylite
