#pragma once

#include <numbers>

namespace tachylite {

inline constexpr double kPi = std::numbers::pi;

}  // namespace tachylite
