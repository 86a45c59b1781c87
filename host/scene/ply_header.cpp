#include "scene/ply_header.h"

#include <optional>

#include "scene/parse_value.h"

namespace tachylite {
namespace {

constexpr size_t kMostNames = 1000;  // elements, and properties of one

PlyType read_type(TextCursor& cursor) {
  const std::string_view word = cursor.word();
  if (word == "char" || word == "int8") return PlyType::kInt8;
  if (word == "uchar" || word == "uint8") return PlyType::kUint8;
  if (word == "short" || word == "int16") return PlyType::kInt16;
  if (word == "ushort" || word == "uint16") return PlyType::kUint16;
  if (word == "int" || word == "int32") return PlyType::kInt32;
  if (word == "uint" || word == "uint32") return PlyType::kUint32;
  if (word == "float" || word == "float32") return PlyType::kFloat32;
  if (word == "double" || word == "float64") return PlyType::kFloat64;
  cursor.fail(fmt::format("\"{:.30}\" is no type of PLY files", word));
}

PlyHeader::Format read_format(TextCursor& cursor) {
  const std::string_view word = cursor.word();
  if (cursor.word() != "1.0") cursor.fail("PLY files of other versions than 1.0 are not supported");
  if (word == "ascii") return PlyHeader::Format::kAscii;
  if (word == "binary_little_endian") return PlyHeader::Format::kLittleEndian;
  if (word == "binary_big_endian") return PlyHeader::Format::kBigEndian;
  cursor.fail(fmt::format("format \"{:.30}\" is not ascii, binary_little_endian or binary_big_endian", word));
}

PlyElement read_element(TextCursor& cursor) {
  PlyElement element;
  element.where = cursor.where();
  element.name = cursor.word();
  const std::string_view count = cursor.word();
  const auto value = parse_integer(count);
  if (!value || *value < 0)
    cursor.fail(fmt::format("count of element {} is \"{:.30}\"", element.name, count));
  element.count = static_cast<uint64_t>(*value);
  return element;
}

PlyProperty read_property(TextCursor& cursor, PlyElement& element) {
  PlyProperty property;
  TextCursor ahead = cursor;
  if (ahead.word() == "list") {
    cursor.word();
    property.is_list = true;
    property.count_type = read_type(cursor);
    if (largest_integer(property.count_type) == 0) cursor.fail("the length of a list must be an integer");
  }
  property.type = read_type(cursor);
  property.name = cursor.word();
  if (property.name.empty()) cursor.fail("a property has no name");
  if (element.find(property.name) >= 0)
    cursor.fail(fmt::format("element {} has the property {:.30} twice", element.name, property.name));
  return property;
}

/// Bytes that a row takes at least.
uint64_t fewest_bytes(const PlyElement& element, PlyHeader::Format format) {
  uint64_t bytes = 0;
  for (const PlyProperty& property : element.properties)
    bytes += format == PlyHeader::Format::kAscii
                 ? 2
                 : byte_size(property.is_list ? property.count_type : property.type);
  return bytes;
}

}  // namespace

int PlyElement::find(std::string_view property) const {
  for (size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == property) return static_cast<int>(i);
  return -1;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
  for (const PlyElement& candidate : elements)
    if (candidate.name == element) return &candidate;
  return nullptr;
}

PlyHeader read_ply_header(TextCursor& cursor) {
  if (cursor.word() != "ply") cursor.fail("not a PLY file: it does not start with ply");
  PlyHeader header;
  bool has_format = false;
  for (cursor.skip_line();; cursor.skip_line()) {
    if (cursor.at_end()) cursor.fail("the header of the PLY file has no end_header");
    const std::string_view keyword = cursor.word();
    if (keyword == "end_header") break;
    if (keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "format") {
      header.format = read_format(cursor);
      has_format = true;
    } else if (keyword == "element") {
      PlyElement element = read_element(cursor);
      if (header.find(element.name)) cursor.fail(fmt::format("element {:.30} is given twice", element.name));
      if (header.elements.size() >= kMostNames) cursor.fail(fmt::format("more than {} elements", kMostNames));
      header.elements.push_back(std::move(element));
    } else if (keyword == "property") {
      if (header.elements.empty()) cursor.fail("a property stands before the first element");
      PlyElement& element = header.elements.back();
      if (element.properties.size() >= kMostNames)
        cursor.fail(fmt::format("element {:.30} has more than {} properties", element.name, kMostNames));
      element.properties.push_back(read_property(cursor, element));
    } else {
      cursor.fail(fmt::format("\"{:.30}\" in the header of a PLY file", keyword));
    }
    if (!cursor.at_line_end()) cursor.fail("the line has more words than expected");
  }
  if (!has_format) cursor.fail("the header of the PLY file names no format");
  cursor.skip_line();

  uint64_t available = cursor.rest().size();
  for (const PlyElement& element : header.elements) {
    const uint64_t row = fewest_bytes(element, header.format);
    if (row == 0) continue;
    // The last number of a text file needs no separator.
    if (element.count > (available + 1) / row)
      throw InputError(element.where,
                       fmt::format("{} rows of element {} do not fit into the {} bytes that are left: "
                                   "the file is cut short",
                                   element.count, element.name, available));
    available -= std::min(available, element.count * row);
  }
  return header;
}

}  // namespace tachylite
