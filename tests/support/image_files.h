#pragma once

// Image files as bytes, uncompressed: what other programs write in forms that ours does not.

#include <cstdint>
#include <string>
#include <vector>

namespace tachylite::test {

/// `channels` 1 to 4 (grey, grey and alpha, RGB, RGBA), of 8 or 16 bits; texels from the top, values of 16 bits or 8.
std::string png_file(int width, int height, int channels, int bits, const std::vector<uint16_t>& texels);

/// Channels Y (1) or R G B (3) of 32-bit floats or halves.
std::string exr_file(int width, int height, int channels, bool half, const std::vector<float>& texels);

/// Targa of 1, 3 (B G R) or 4 (B G R A) channels of 8 bits, from the top.
std::string tga_file(int width, int height, int channels, const std::vector<uint8_t>& texels);

/// Radiance HDR, from the top; width < 8, which readers take to be without run lengths.
std::string hdr_file(int width, int height, const std::vector<float>& rgb);

}  // namespace tachylite::test
