#pragma once

#include <span>

#include "image/image.h"

namespace tachylite {

constexpr float kLeastMappedError = 0.01f, kMostMappedError = 1.0f;

/// Relative errors of pixels as colours: black through violet and orange to pale yellow, logarithmic from
/// kLeastMappedError to kMostMappedError. Linear R G B.
Image color_map(int width, int height, std::span<const float> errors);

}  // namespace tachylite
