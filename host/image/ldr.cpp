#include "image/ldr.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>

#include "base/atomic_file.h"
#include "base/check.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/read_file.h"
#include "image/stb.h"

namespace tachylite {
namespace {

/// stb_image takes zeros for what a file lacks, and may wait for something else for ever. This source gives
/// ones beyond the end, and notes that it was asked for more than there is.
struct Source {
  std::string_view bytes;
  size_t position = 0;
  bool cut_short = false;

  static int read(void* user, char* data, int size) {
    auto& self = *static_cast<Source*>(user);
    const size_t n = std::min(static_cast<size_t>(size), self.bytes.size() - self.position);
    if (n == 0) {
      self.cut_short = true;
      std::memset(data, '\n', static_cast<size_t>(size));
      return size;
    }
    std::memcpy(data, self.bytes.data() + self.position, n);
    self.position += n;
    return static_cast<int>(n);
  }
  static void skip(void* user, int n) {
    auto& self = *static_cast<Source*>(user);
    const int64_t target = static_cast<int64_t>(self.position) + n;
    if (target > static_cast<int64_t>(self.bytes.size())) self.cut_short = true;
    self.position =
        static_cast<size_t>(std::clamp<int64_t>(target, 0, static_cast<int64_t>(self.bytes.size())));
  }
  static int eof(void* user) {
    const auto& self = *static_cast<const Source*>(user);
    return self.position >= self.bytes.size();
  }
  static constexpr stbi_io_callbacks kCallbacks{&read, &skip, &eof};
};

/// The tables that a JPEG has defined, a bit each, by class and number.
struct JpegTables {
  uint32_t huffman[2] = {0, 0};  // dc, ac
  uint32_t quantisation = 0;
  uint32_t used_quantisation = 0;  // by the frame's components
  bool progressive = false;
};

/// Whether a scan with that header (count; component and tables of each; start, end and bits of the coefficients) finds
/// its tables.
bool has_tables(const JpegTables& tables, std::string_view scan) {
  const auto byte = [&](size_t i) { return i < scan.size() ? static_cast<uint8_t>(scan[i]) : 0u; };
  const size_t count = byte(0);
  const bool first_dc = byte(1 + 2 * count) == 0, refines = byte(3 + 2 * count) >> 4 != 0;
  const bool dc = !tables.progressive || (first_dc && !refines), ac = !tables.progressive || !first_dc;
  for (size_t i = 0; i < count; ++i) {
    const uint32_t which = byte(2 + 2 * i);
    if (dc && !(tables.huffman[0] >> (which >> 4) & 1)) return false;
    if (ac && !(tables.huffman[1] >> (which & 15) & 1)) return false;
  }
  return (tables.used_quantisation & ~tables.quantisation) == 0;
}

/// What stb_image does not check in a JPEG: that entropy-coded data go on to the end marker (else the rest is grey),
/// that a Huffman table has at most 256 codes (else it writes past its own), and that a scan's tables have been
/// defined (else it decodes by what memory held before).
void check_jpeg(const FileLocation& where, std::string_view bytes) {
  const size_t first = bytes.find_first_not_of('\xff');  // fill bytes may stand before a marker
  if (first == 0 || first == bytes.npos || bytes[first] != '\xd8') return;
  const auto byte = [&](size_t i) -> size_t {
    if (i >= bytes.size()) throw InputError(where, "the image file is cut short");
    return static_cast<unsigned char>(bytes[i]);
  };
  JpegTables tables;
  for (size_t i = first + 1;;) {
    // Markers are 0xff and a code other than 0xff (padding), 0 (a data byte 0xff) and the restarts inside
    // scans.
    while (byte(i) != 0xff || byte(i + 1) == 0xff || byte(i + 1) == 0 || (byte(i + 1) & 0xf8) == 0xd0) ++i;
    const size_t marker = byte(i + 1), begin = i + 4;
    if (marker == 0xd9) return;  // end of image
    const size_t end = i + 2 + 256 * byte(i + 2) + byte(i + 3);
    if (end < begin) throw InputError(where, "the image cannot be decoded: broken segment");
    if (marker == 0xc4)  // Huffman tables: a class, 16 counts, the symbols
      for (size_t table = begin; table < end;) {
        size_t codes = 0;
        for (size_t k = 1; k <= 16; ++k) codes += byte(table + k);
        if (codes > 256) throw InputError(where, "the image cannot be decoded: broken Huffman table");
        tables.huffman[byte(table) >> 4 & 1] |= 1u << (byte(table) & 15);
        table += 17 + codes;
      }
    if (marker == 0xdb)  // quantisation tables: precision and number, 64 values
      for (size_t table = begin; table < end; table += byte(table) >> 4 == 0 ? 65 : 129)
        tables.quantisation |= 1u << (byte(table) & 15);
    if (marker >= 0xc0 && marker <= 0xc2) {  // frame: 6 bytes, then 3 a component, of which the last names a table
      tables.progressive = marker == 0xc2;
      for (size_t component = begin + 6; component + 2 < end; component += 3)
        tables.used_quantisation |= 1u << (byte(component + 2) & 15);
    }
    if (marker == 0xda && !has_tables(tables, bytes.substr(begin, end - begin)))
      throw InputError(where, "the image cannot be decoded: a table is missing");
    i = end;
  }
}

/// stb_image allocates what the header of a PNG chunk asks for before it reads on.
void check_png(const FileLocation& where, std::string_view bytes) {
  if (!bytes.starts_with("\x89PNG\r\n\x1a\n")) return;
  for (size_t i = 8; i + 12 <= bytes.size();) {
    uint64_t length = 0;
    for (size_t k = 0; k < 4; ++k) length = length << 8 | static_cast<unsigned char>(bytes[i + k]);
    if (bytes.substr(i + 4, 4) == "IEND") return;
    if (length > bytes.size() - i - 12) break;
    i += 12 + length;
  }
  throw InputError(where, "the image file is cut short");
}

template <typename T>
std::vector<T> take(T* decoded, const DecodedImage& image) {
  const std::unique_ptr<T, decltype(&stbi_image_free)> owner(decoded, &stbi_image_free);
  if (!decoded) return {};
  const size_t count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height) *
                       static_cast<size_t>(image.channels);
  return std::vector<T>(decoded, decoded + count);
}

}  // namespace

float linear_to_srgb(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

float srgb_to_linear(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

std::vector<uint8_t> encode_png(const Image& image) {
  const std::vector<float>* rgb[3] = {image.find("R"), image.find("G"), image.find("B")};
  CHECK(rgb[0] && rgb[1] && rgb[2]);
  const size_t count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  std::vector<uint8_t> bytes(3 * count);
  for (size_t i = 0; i < count; ++i)
    for (size_t c = 0; c < 3; ++c) {
      const float value = (*rgb[c])[i];
      const float clamped = value > 0 ? std::min(value, 1.0f) : 0.0f;  // NaN becomes 0
      bytes[3 * i + c] = static_cast<uint8_t>(std::lround(255 * linear_to_srgb(clamped)));
    }
  std::vector<uint8_t> png;
  const auto append = [](void* context, void* data, int size) {
    const auto* first = static_cast<const uint8_t*>(data);
    auto& all = *static_cast<std::vector<uint8_t>*>(context);
    all.insert(all.end(), first, first + size);
  };
  if (!stbi_write_png_to_func(append, &png, image.width, image.height, 3, bytes.data(), 0))
    throw RenderError("the image could not be encoded as PNG");
  return png;
}

void write_png(const std::filesystem::path& file, const Image& image) {
  const std::vector<uint8_t> png = encode_png(image);
  write_atomically(file, [&](const std::filesystem::path& beside) {
    std::ofstream stream(beside, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
    stream.close();
    if (!stream) throw RenderError(fmt::format("cannot write {}", file.string()));
  });
}

DecodedImage read_ldr(const std::filesystem::path& file, size_t max_pixels) {
  const FileLocation where = locate_file(file);
  const FileBytes content = read_file(file, uint64_t{1} << 30);
  const std::string_view bytes = content.view();

  // Look at the header before anything is allocated.
  check_jpeg(where, bytes);
  check_png(where, bytes);
  DecodedImage image;
  Source header{bytes};
  if (!stbi_info_from_callbacks(&Source::kCallbacks, &header, &image.width, &image.height, &image.channels))
    throw InputError(
        where, fmt::format("not a readable PNG, JPEG, BMP, TGA or HDR image: {}", stbi_failure_reason()));
  if (image.width < 1 || image.height < 1) throw InputError(where, "the image is empty");
  if (static_cast<size_t>(image.width) > max_pixels / static_cast<size_t>(image.height))
    throw InputError(where, fmt::format("the image has {} x {} pixels; at most {} are read", image.width,
                                        image.height, max_pixels));

  // What the format can pack at most: deflate 1032 bytes of 8 grey pixels into one, Radiance's runs 127 into
  // 8 bytes.
  Source hdr_source{bytes}, wide_source{bytes}, source{bytes};
  const bool hdr = stbi_is_hdr_from_callbacks(&Source::kCallbacks, &hdr_source);
  const size_t most_pixels = bytes.size() * (hdr ? 16 : 8 * 1032);
  if (static_cast<size_t>(image.width) * static_cast<size_t>(image.height) > most_pixels)
    throw InputError(where, "the image file is cut short");
  const bool wide = !hdr && stbi_is_16_bit_from_callbacks(&Source::kCallbacks, &wide_source);
  // Decoded, and once more as it is kept.
  require_memory(where, fmt::format("the image of {} x {} pixels", image.width, image.height),
                 2 * (hdr ? 4u : wide ? 2u : 1u) * static_cast<uint64_t>(image.channels) *
                     static_cast<uint64_t>(image.width) * static_cast<uint64_t>(image.height));
  const auto decode = [&](auto* load) {
    return take(load(&Source::kCallbacks, &source, &image.width, &image.height, &image.channels, 0), image);
  };
  if (hdr) {
    image.floats = decode(stbi_loadf_from_callbacks);
  } else if (wide) {
    image.words = decode(stbi_load_16_from_callbacks);
  } else {
    image.bytes = decode(stbi_load_from_callbacks);
  }
  if (image.bytes.empty() && image.words.empty() && image.floats.empty())
    throw InputError(where, fmt::format("the image cannot be decoded: {}", stbi_failure_reason()));
  if (source.cut_short) throw InputError(where, "the image file is cut short");
  return image;
}

}  // namespace tachylite
