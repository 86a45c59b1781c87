#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tachylite {

/// Sums of doubles, one a pixel, that are the same bit for bit in whatever order and grouping values are added: what
/// merging and resuming renders stand on. After Demmel and Nguyen 2015, "Parallel Reproducible Summation": a value is
/// cut into digits of 38 bits at fixed places of the number line; of each sum the two digits at the top are kept as
/// integers, whose addition is exact. Unlike theirs, digits are integers and no carries are needed.
///
/// Each value is rounded, to nearest, by at most 2^-38 of the largest value of its sum. At most kMaxValues a sum.
class ReproducibleSums {
 public:
  static constexpr uint64_t kMaxValues = uint64_t{1} << 22;

  explicit ReproducibleSums(size_t count = 0) : high_(count, 0), low_(count, 0), place_(count, kLowestPlace) {}

  size_t size() const { return high_.size(); }

  /// `value` is finite.
  void add(size_t i, double value) {
    double scaled = value * inverse_unit(place_[i]);
    if (!(std::abs(scaled) < kHalf)) {
      raise(i, place_of(value));
      scaled = value * inverse_unit(place_[i]);
    }
    const double high = round(scaled);
    high_[i] += static_cast<int64_t>(high);
    low_[i] += static_cast<int64_t>(round((scaled - high) * kBase));
  }
  void add(const ReproducibleSums& other);  // of the same size

  double value(size_t i) const;

  /// The exact state of a sum as four words, and back: sums of the same values have equal words; 0 has zeros.
  /// set_words returns false for words that no sum has.
  using Words = std::array<uint32_t, 4>;
  Words words(size_t i) const;
  bool set_words(size_t i, const Words& words);

 private:
  static constexpr int kDigitBits = 38;
  static constexpr double kBase = 0x1p38, kInverseBase = 0x1p-38, kHalf = 0x1p37;
  static constexpr int kLowestPlace = -26, kHighestPlace = 26;  // the upper digit's unit is 2^(38 place)

  /// The integer nearest to |x| < 2^51, ties to even.
  static double round(double x) {
    constexpr double kShift = 0x1.8p52;
    return (x + kShift) - kShift;
  }
  static double unit(int place) { return std::bit_cast<double>(static_cast<uint64_t>(1023 + kDigitBits * place) << 52); }
  static double inverse_unit(int place) { return unit(-place); }
  static int8_t place_of(double value);  // the lowest with |value| < unit * kHalf
  void raise(size_t i, int8_t place);

  // value = 2^(38 place) high + 2^(38 (place - 1)) low. No carry from low to high: what drops out in raise() must not
  // depend on when.
  std::vector<int64_t> high_, low_;
  std::vector<int8_t> place_;
};

}  // namespace tachylite
