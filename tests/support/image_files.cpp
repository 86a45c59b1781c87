#include "support/image_files.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

namespace tachylite::test {
namespace {

template <class T>
void append_little(std::string& bytes, T value) {
  for (size_t i = 0; i < sizeof(T); ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
}
void append_big(std::string& bytes, uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
}

/// CRC-32 of ISO 3309, bit by bit.
uint32_t crc32(std::string_view bytes) {
  uint32_t crc = ~0u;
  for (const char byte : bytes) {
    crc ^= static_cast<uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}
uint32_t adler32(std::string_view bytes) {
  uint32_t a = 1, b = 0;
  for (const char byte : bytes) {
    a = (a + static_cast<uint8_t>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

void append_chunk(std::string& png, const std::string& type, const std::string& data) {
  append_big(png, static_cast<uint32_t>(data.size()));
  png += type + data;
  append_big(png, crc32(type + data));
}

void append_attribute(std::string& exr, const std::string& name, const std::string& type, const std::string& value) {
  exr.append(name).append(1, '\0').append(type).append(1, '\0');
  append_little(exr, static_cast<uint32_t>(value.size()));
  exr += value;
}
std::string words(std::initializer_list<uint32_t> values) {
  std::string bytes;
  for (const uint32_t value : values) append_little(bytes, value);
  return bytes;
}

}  // namespace

std::string png_file(int width, int height, int channels, int bits, const std::vector<uint16_t>& texels) {
  std::string header;
  append_big(header, static_cast<uint32_t>(width));
  append_big(header, static_cast<uint32_t>(height));
  header += static_cast<char>(bits);
  header += "\0\4\2\6"[channels - 1];  // colour type
  header.append(3, '\0');

  // Rows without a filter, in one stored block of deflate.
  std::string rows;
  const auto row_texels = static_cast<size_t>(width * channels);
  for (size_t i = 0; i < texels.size(); ++i) {
    if (i % row_texels == 0) rows += '\0';
    if (bits == 16) rows += static_cast<char>(texels[i] >> 8);
    rows += static_cast<char>(texels[i] & 0xff);
  }
  std::string zlib = "\x78\x01\x01";
  append_little(zlib, static_cast<uint16_t>(rows.size()));
  append_little(zlib, static_cast<uint16_t>(~rows.size()));
  zlib += rows;
  append_big(zlib, adler32(rows));

  std::string png = "\x89PNG\r\n\x1a\n";
  append_chunk(png, "IHDR", header);
  append_chunk(png, "IDAT", zlib);
  append_chunk(png, "IEND", "");
  return png;
}

std::string exr_file(int width, int height, int channels, bool half, const std::vector<float>& texels) {
  const auto w = static_cast<uint32_t>(width), h = static_cast<uint32_t>(height);
  const std::string_view names = channels == 1 ? "Y" : "BGR";  // in alphabetical order
  std::string list;
  for (const char name : names) list.append(1, name).append(1, '\0').append(words({half ? 1u : 2u, 0, 1, 1}));
  list += '\0';
  const std::string window = words({0, 0, w - 1, h - 1});

  std::string exr = words({20000630, 2});
  append_attribute(exr, "channels", "chlist", list);
  append_attribute(exr, "compression", "compression", std::string(1, '\0'));
  append_attribute(exr, "dataWindow", "box2i", window);
  append_attribute(exr, "displayWindow", "box2i", window);
  append_attribute(exr, "lineOrder", "lineOrder", std::string(1, '\0'));
  append_attribute(exr, "pixelAspectRatio", "float", words({std::bit_cast<uint32_t>(1.0f)}));
  append_attribute(exr, "screenWindowCenter", "v2f", words({0, 0}));
  append_attribute(exr, "screenWindowWidth", "float", words({std::bit_cast<uint32_t>(1.0f)}));
  exr += '\0';

  // Offsets of the rows, then the rows: number, bytes, a run of texels a channel.
  const uint32_t row_bytes = w * static_cast<uint32_t>(channels) * (half ? 2 : 4);
  const uint64_t first = exr.size() + 8 * size_t{h};
  for (uint32_t y = 0; y < h; ++y) append_little(exr, first + uint64_t{y} * (8 + row_bytes));
  for (uint32_t y = 0; y < h; ++y) {
    exr += words({y, row_bytes});
    for (int c = channels - 1; c >= 0; --c)
      for (uint32_t x = 0; x < w; ++x) {
        const float value = texels[(size_t{y} * w + x) * static_cast<size_t>(channels) + static_cast<size_t>(c)];
        if (half) append_little(exr, glm::packHalf1x16(value));
        else append_little(exr, std::bit_cast<uint32_t>(value));
      }
  }
  return exr;
}

std::string tga_file(int width, int height, int channels, const std::vector<uint8_t>& texels) {
  std::string tga = {0, 0, static_cast<char>(channels == 1 ? 3 : 2), 0, 0, 0, 0, 0, 0, 0, 0, 0};
  append_little(tga, static_cast<uint16_t>(width));
  append_little(tga, static_cast<uint16_t>(height));
  tga += static_cast<char>(8 * channels);
  tga += static_cast<char>(0x20);  // rows from the top
  return tga.append(texels.begin(), texels.end());
}

std::string hdr_file(int width, int height, const std::vector<float>& rgb) {
  std::string hdr = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", height, width);
  for (size_t i = 0; i < rgb.size(); i += 3) {
    const float largest = std::max({rgb[i], rgb[i + 1], rgb[i + 2]});
    int exponent = 0;
    std::frexp(largest, &exponent);
    for (size_t c = 0; c < 3; ++c)
      hdr += static_cast<char>(largest > 0 ? static_cast<int>(std::ldexp(rgb[i + c], 8 - exponent)) : 0);
    hdr += static_cast<char>(largest > 0 ? exponent + 128 : 0);
  }
  return hdr;
}

}  // namespace tachylite::test
