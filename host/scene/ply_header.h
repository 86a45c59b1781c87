#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/text_cursor.h"

namespace tachylite {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };
constexpr size_t byte_size(PlyType type) {
  constexpr size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<size_t>(type)];
}
/// Largest value of an integer type, 0 for floating point types.
constexpr double largest_integer(PlyType type) {
  constexpr double kLargest[] = {127, 255, 32767, 65535, 2147483647, 4294967295, 0, 0};
  return kLargest[static_cast<size_t>(type)];
}

struct PlyProperty {
  std::string name;
  PlyType type;
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  // of lists
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;
  FileLocation where;

  int find(std::string_view property) const;  // its index, or -1
};

struct PlyHeader {
  enum class Format { kAscii, kLittleEndian, kBigEndian };
  Format format = Format::kAscii;
  std::vector<PlyElement> elements;

  const PlyElement* find(std::string_view element) const;
};

/// Reads up to and including the line end_header. Counts of elements are checked against the bytes that
/// follow, so that memory may be reserved for them.
PlyHeader read_ply_header(TextCursor& cursor);

}  // namespace tachylite
