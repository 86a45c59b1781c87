#pragma once

#include <array>

namespace tachylite {

/// Tables from 360 to 830 nm in steps of 5 nm.
constexpr int kCieFirst = 360, kCieLast = 830, kCieStep = 5;
constexpr int kCieCount = (kCieLast - kCieFirst) / kCieStep + 1;

/// CIE 1931 2-degree standard observer (CIE 015:2018).
extern const std::array<double, kCieCount> kCieX, kCieY, kCieZ;
/// Integral of kCieY over wavelength [nm] by 1000 equal weights from end to end: 0.999 of the true one.
constexpr double kCieYIntegral = 106.7502593994140625;

/// Relative power of CIE standard illuminant D65, 100 at 560 nm.
extern const std::array<double, kCieCount> kD65;
/// What scales kD65 so that its luminance is that of the constant spectrum 1.
constexpr double kD65Normalization = 98.99741751876255;

}  // namespace tachylite
