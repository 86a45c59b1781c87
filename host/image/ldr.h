#pragma once

#include <cstdint>
#include <filesystem>

#include "image/image.h"

namespace tachylite {

/// The channels R G B as 8-bit sRGB PNG of the image clamped to [0, 1]. Throws RenderError.
std::vector<uint8_t> encode_png(const Image& image);
/// Writes the channels R G B as 8-bit sRGB PNG of the image clamped to [0, 1]; whole or not at all.
void write_png(const std::filesystem::path& file, const Image& image);

/// Texels as they stood in the file, row 0 on top, width * height * channels of one of the three kinds.
struct DecodedImage {
  int width = 0, height = 0;
  int channels = 0;             // 1 (grey), 2 (grey, alpha), 3 or 4
  std::vector<uint8_t> bytes;   // PNG, JPEG, BMP, TGA of 8 bits
  std::vector<uint16_t> words;  // PNG of 16 bits
  std::vector<float> floats;    // Radiance HDR
};

/// Reads PNG, JPEG, BMP, TGA and Radiance HDR. Throws InputError when the file is missing, broken, cut short
/// or larger than `max_pixels`.
DecodedImage read_ldr(const std::filesystem::path& file, size_t max_pixels = size_t{1} << 28);

/// The sRGB transfer function (IEC 61966-2-1), [0, 1] to [0, 1], and its inverse.
float linear_to_srgb(float linear);
float srgb_to_linear(float encoded);

}  // namespace tachylite
