#pragma once

#include <bit>
#include <cstdint>

namespace tachylite {

/// Tables of words hold numbers as float32.
inline uint32_t bits(double x) { return std::bit_cast<uint32_t>(static_cast<float>(x)); }
inline float as_float(uint32_t bits) { return std::bit_cast<float>(bits); }

}  // namespace tachylite
