#pragma once

#include <span>

namespace tachylite {

/// A point of a curve of error against time.
struct TimedError {
  double seconds = 0, error = 0;
};

struct TimeToError {
  double seconds = 0;
  bool extrapolated = false;  // the error lies outside of what was measured
};

/// When a curve (in order of time) reaches an error: linear in the logarithms between its points; where the curve
/// crosses several times, the last. Beyond its ends it goes on from there with the slope of the three points nearest
/// (least squares). Needs two points, all positive; seconds are infinite where the curve does not fall.
TimeToError time_to_error(std::span<const TimedError> curve, double error);

/// The exponent b of error ~ seconds^b, by least squares in the logarithms.
double convergence_exponent(std::span<const TimedError> curve);

}  // namespace tachylite
