#pragma once

// Figures with confidence intervals, by the bootstrap (Efron 1979, "Bootstrap methods: another look at the
// jackknife").

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tachylite {

/// A measured positive figure, its 95 % interval, and the standard error of its logarithm.
struct Estimate {
  double value = 0, low = 0, high = 0, log_error = 0;
};

constexpr size_t kReplicates = 1000;

/// Values that a figure takes when its data are drawn anew, kReplicates of them.
struct Replicates {
  double value = 0;  // from the data themselves
  std::vector<double> drawn;
};

/// The mean of few repeated measurements that come out a little different each time. The spread of the drawn means is
/// widened to what Student's t asks for so few of them, and by sqrt(n / (n - 1)) for the bootstrap's own bias; with a
/// single measurement nothing is known of it, and it is 0.
Replicates bootstrap_mean(std::span<const double> measurements, uint64_t seed);

/// The sum over blocks of the mean over seeds of errors[seed][block]. Blocks of an image are independent of each
/// other, as their random numbers are: each draws its own seeds, so that a few seeds give many degrees of freedom.
/// `fitted`: how much of the n seeds of a block its own mean takes, 1 for errors that are independent of each other, 2
/// for deviations from the mean of the seeds (whose mean has a variance 1 / (n - 1), not (1 - 1 / (n - 1)^2) / n, of one
/// normal deviation's); the spread is widened by sqrt(n / (n - fitted)). n > fitted.
Replicates bootstrap_blocks(std::span<const std::vector<double>> errors, size_t fitted, uint64_t seed);

/// f of each draw of the two.
Replicates combine(const Replicates& a, const Replicates& b, const std::function<double(double, double)>& f);

/// The percentile interval of the draws.
Estimate estimate(const Replicates& replicates);

/// a / b of figures measured apart from each other: the errors of their logarithms add in squares.
Estimate ratio(const Estimate& a, const Estimate& b);

}  // namespace tachylite
