#pragma once

// A stress case: a scene whose image is known. It is rendered on the device and by the reference, and each is held to the
// bound. The worst errors are printed for README.md.

#include <functional>
#include <string>

#include "support/render_test.h"

namespace tachylite::test {

struct StressCase {
  std::string name;
  uint64_t samples = 16;
  double bound = 0;  // of the error
  /// Of an image; what it is relative to is the case's business.
  std::function<double(const FilmBuffer&)> error;
  /// The reference's, where its paths are more random: it samples every sky.
  std::function<double(const FilmBuffer&)> reference_error = nullptr;
  bool on_reference = true;
  bool both_structures = false;  // also as stages, where one kernel would do
};
void expect_stress(const Scene& scene, const StressCase& c);

/// Largest relative error of a pixel's channel against one value.
std::function<double(const FilmBuffer&)> worst_pixel(double expected);
/// Relative error of the image's mean, beyond five standard errors of it, against the value of each channel.
std::function<double(const FilmBuffer&)> mean_beyond_noise(const glm::dvec3& expected);

}  // namespace tachylite::test
