#include "measure/convergence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace tachylite {

double convergence_exponent(std::span<const TimedError> curve) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const TimedError& point : curve) {
    const double log_seconds = std::log(point.seconds), log_error = std::log(point.error);
    ++n, x += log_seconds, y += log_error;
    xx += log_seconds * log_seconds, xy += log_seconds * log_error;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

TimeToError time_to_error(std::span<const TimedError> curve, double error) {
  CHECK_LE(size_t{2}, curve.size());
  for (size_t i = curve.size() - 1; i-- > 0;) {
    const TimedError &a = curve[i], &b = curve[i + 1];
    if (a.error < error || b.error > error) continue;
    const double t = a.error > b.error ? std::log(a.error / error) / std::log(a.error / b.error) : 1;
    return {a.seconds * std::pow(b.seconds / a.seconds, t), false};
  }
  const size_t near = std::min<size_t>(curve.size(), 3);
  const bool before = curve.front().error < error;
  const double exponent = convergence_exponent(before ? curve.first(near) : curve.last(near));
  const TimedError& end = before ? curve.front() : curve.back();
  if (!(exponent < 0)) return {std::numeric_limits<double>::infinity(), true};
  return {end.seconds * std::pow(error / end.error, 1 / exponent), true};
}

}  // namespace tachylite
