#include "image/exr_header.h"

#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <string_view>

#include <ImfHeader.h>

#include "base/error.h"

namespace tachylite {
namespace {

/// Types whose values OpenEXR reads whatever size the file gives, and what they take [bytes].
const std::map<std::string_view, uint64_t> kFixedSizes = {
    {"box2f", 16},         {"box2i", 16},   {"chromaticities", 32}, {"compression", 1}, {"deepImageState", 1},
    {"double", 8},         {"envmap", 1},   {"float", 4},           {"int", 4},         {"keycode", 28},
    {"lineOrder", 1},      {"m33d", 72},    {"m33f", 36},           {"m44d", 128},      {"m44f", 64},
    {"rational", 8},       {"tiledesc", 9}, {"timecode", 8},        {"v2d", 16},        {"v2f", 8},
    {"v2i", 8},            {"v3d", 24},     {"v3f", 12},            {"v3i", 12}};

uint64_t little_endian(std::string_view bytes) {
  uint64_t value = 0;
  for (size_t k = 0; k < 4; ++k) value |= uint64_t{static_cast<uint8_t>(bytes[k])} << 8 * k;
  return value;
}

/// Whether the value of an attribute has the length that OpenEXR will read.
bool is_whole(std::string_view type, std::string_view value) {
  if (const auto fixed = kFixedSizes.find(type); fixed != kFixedSizes.end()) return value.size() == fixed->second;
  if (type == "preview")  // width, height, bytes of RGBA
    return value.size() >= 8 && (value.size() - 8) / 4 == little_endian(value) * little_endian(value.substr(4)) &&
           value.size() % 4 == 0;
  if (type != "chlist") return true;
  constexpr size_t kAfterName = 16;
  while (true) {  // names, each with 16 bytes; an empty one ends them
    const size_t end = value.find('\0');
    if (end == value.npos) return false;
    if (end == 0) return value.size() == 1;
    if (value.size() - end - 1 < kAfterName) return false;
    value.remove_prefix(end + 1 + kAfterName);
  }
}

}  // namespace

// Attributes are name, type, size, value; an empty name ends them, one more the headers of several parts.
void check_exr_header(const FileLocation& where, const std::filesystem::path& path) {
  constexpr int kMaxSide = 1 << 17, kMaxTileSide = 1 << 12;
  static const bool limited = [] {
    Imf::Header::setMaxImageSize(kMaxSide, kMaxSide);
    Imf::Header::setMaxTileSize(kMaxTileSide, kMaxTileSide);
    return true;
  }();
  static_cast<void>(limited);

  std::ifstream file(path, std::ios::binary);
  const uintmax_t file_size = std::filesystem::file_size(path);
  char version[8]{};  // magic number and version with flags
  file.read(version, sizeof version);
  const bool several = (version[5] & 0x10) != 0;
  std::string name, type, value;
  for (bool ended = true; std::getline(file, name, '\0');) {
    if (name.empty() && (ended || !several)) return;
    ended = name.empty();
    if (ended) continue;
    char size[4]{};
    std::getline(file, type, '\0');
    file.read(size, sizeof size);
    const uint64_t bytes = little_endian({size, sizeof size});
    if (!file || bytes > file_size)
      throw InputError(where, "not a readable EXR file: an attribute is cut short");
    value.resize(bytes);
    file.read(value.data(), static_cast<std::streamsize>(bytes));
    if (!file || !is_whole(type, value))
      throw InputError(where, "not a readable EXR file: an attribute is broken");
  }
}

}  // namespace tachylite
