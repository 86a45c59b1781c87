#include "image/reproducible_sums.h"

#include <algorithm>

#include "base/check.h"

namespace tachylite {

int8_t ReproducibleSums::place_of(double value) {
  int place = kLowestPlace;
  while (place < kHighestPlace && !(std::abs(value) * inverse_unit(place) < kHalf)) ++place;
  return static_cast<int8_t>(place);
}

void ReproducibleSums::raise(size_t i, int8_t place) {
  // The upper digit becomes the lower one, or drops out. A value that was below half a unit of the new place has the
  // upper digit 0 there, so that nothing else changes.
  const int places = place - place_[i];
  low_[i] = places == 1 ? high_[i] : 0;
  high_[i] = 0;
  place_[i] = place;
}

void ReproducibleSums::add(const ReproducibleSums& other) {
  CHECK_EQ(size(), other.size());
  for (size_t i = 0; i < size(); ++i) {
    if (other.place_[i] > place_[i]) raise(i, other.place_[i]);
    if (other.place_[i] == place_[i]) {
      high_[i] += other.high_[i];
      low_[i] += other.low_[i];
    } else if (other.place_[i] + 1 == place_[i]) {
      low_[i] += other.high_[i];
    }
  }
}

double ReproducibleSums::value(size_t i) const {
  // Carry first: then the upper digit alone is right to the last bit of a double or two.
  const int64_t carry = low_[i] >> kDigitBits;
  const double scale = unit(place_[i]);
  return static_cast<double>(high_[i] + carry) * scale +
         static_cast<double>(low_[i] - (carry << kDigitBits)) * kInverseBase * scale;
}

// 61 bits of the upper digit, 61 of the lower one, both in two's complement, and 6 of the place.
ReproducibleSums::Words ReproducibleSums::words(size_t i) const {
  const auto place = static_cast<uint64_t>(place_[i] - kLowestPlace);
  const uint64_t upper = static_cast<uint64_t>(high_[i]) << 3 | place >> 3;
  const uint64_t lower = static_cast<uint64_t>(low_[i]) << 3 | (place & 7);
  return {static_cast<uint32_t>(upper >> 32), static_cast<uint32_t>(upper), static_cast<uint32_t>(lower >> 32),
          static_cast<uint32_t>(lower)};
}

bool ReproducibleSums::set_words(size_t i, const Words& words) {
  const auto upper = static_cast<int64_t>(uint64_t{words[0]} << 32 | words[1]);
  const auto lower = static_cast<int64_t>(uint64_t{words[2]} << 32 | words[3]);
  const auto place = static_cast<int>((upper & 7) << 3 | (lower & 7)) + kLowestPlace;
  constexpr int64_t kMost = static_cast<int64_t>(kMaxValues) << (kDigitBits - 1);
  high_[i] = upper >> 3;
  low_[i] = lower >> 3;
  place_[i] = static_cast<int8_t>(std::min(place, kHighestPlace));
  return place <= kHighestPlace && std::abs(high_[i]) <= kMost && std::abs(low_[i]) <= kMost;
}

}  // namespace tachylite
