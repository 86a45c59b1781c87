// PLY (Turk 1994, "The PLY polygon file format"), ASCII and binary of both byte orders.

#include <bit>
#include <cstring>
#include <limits>

#include "base/read_file.h"
#include "scene/load_mesh.h"
#include "scene/ply_attributes.h"
#include "scene/ply_header.h"

namespace tachylite {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Numbers of a text file, wherever its lines end.
class AsciiSource {
 public:
  explicit AsciiSource(const TextCursor& cursor) : cursor_(cursor) {}

  double next(PlyType type) {
    cursor_.skip_space();
    if (cursor_.at_end()) cursor_.fail("the file is cut short");
    const double largest = largest_integer(type);
    const double value = largest > 0 ? static_cast<double>(next_integer()) : cursor_.real("number");
    if (largest > 0 && (value > largest || value < -largest - 1))
      cursor_.fail("a number does not fit into its type");
    return value;
  }
  [[noreturn]] void fail(const std::string& message) const { cursor_.fail(message); }

 private:
  int64_t next_integer() {
    const std::string_view word = cursor_.word();
    int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
      cursor_.fail(fmt::format("\"{:.30}\" stands where a whole number is expected", word));
    return value;
  }
  TextCursor cursor_;
};

template <bool kSwap>
class BinarySource {
 public:
  explicit BinarySource(const TextCursor& cursor) : rest_(cursor.rest()), where_(cursor.where()) {
    where_.line = 0;
  }

  double next(PlyType type) {
    switch (type) {
      case PlyType::kInt8:
        return take<int8_t>();
      case PlyType::kUint8:
        return take<uint8_t>();
      case PlyType::kInt16:
        return take<int16_t>();
      case PlyType::kUint16:
        return take<uint16_t>();
      case PlyType::kInt32:
        return take<int32_t>();
      case PlyType::kUint32:
        return take<uint32_t>();
      case PlyType::kFloat32:
        return static_cast<double>(take<float>());
      case PlyType::kFloat64:
        return take<double>();
    }
    return 0;
  }
  [[noreturn]] void fail(const std::string& message) const { throw InputError(where_, message); }

 private:
  template <typename T>
  T take() {
    if (rest_.size() < sizeof(T)) fail("the file is cut short");
    char bytes[sizeof(T)];
    for (size_t i = 0; i < sizeof(T); ++i) bytes[i] = rest_[kSwap ? sizeof(T) - 1 - i : i];
    rest_.remove_prefix(sizeof(T));
    return std::bit_cast<T>(bytes);
  }
  std::string_view rest_;
  FileLocation where_;
};

template <typename Source>
class PlyReader {
 public:
  PlyReader(Source source, const PlyHeader& header, bool flip_tex_coords, bool skip_normals)
      : source_(std::move(source)), header_(header), flip_(flip_tex_coords), skip_normals_(skip_normals) {}

  Mesh read() {
    const PlyElement* vertices = header_.find("vertex");
    if (!vertices) source_.fail("the PLY file has no element vertex");
    if (vertices->count >= std::numeric_limits<uint32_t>::max())
      source_.fail("the mesh has too many vertices");
    vertex_count_ = static_cast<uint32_t>(vertices->count);
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else if (!element.properties.empty()) {
        for (uint64_t i = 0; i < element.count; ++i) read_row(element, -1, [](double) {});
      }
    }
    return std::move(mesh_);
  }

 private:
  /// Reads one row into row_; the entries of list number `list` go to `on_entry`.
  template <typename OnEntry>
  void read_row(const PlyElement& element, int list, const OnEntry& on_entry) {
    row_.resize(element.properties.size());
    for (size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (!property.is_list) {
        row_[i] = source_.next(property.type);
        continue;
      }
      const double length = source_.next(property.count_type);
      if (length < 0) source_.fail("a list has a negative length");
      for (auto left = static_cast<uint64_t>(length); left > 0; --left) {
        const double entry = source_.next(property.type);
        if (static_cast<int>(i) == list) on_entry(entry);
      }
    }
  }

  void read_vertices(const PlyElement& element) {
    const auto columns = [&](std::initializer_list<const char*> names) {
      std::vector<int> found;
      for (const char* name : names)
        if (const int i = element.find(name); i >= 0 && !element.properties[static_cast<size_t>(i)].is_list)
          found.push_back(i);
      return found.size() == names.size() ? found : std::vector<int>();
    };
    const auto position = columns({"x", "y", "z"});
    if (position.empty()) throw InputError(element.where, "element vertex lacks the properties x, y, z");
    const auto normal = skip_normals_ ? std::vector<int>() : columns({"nx", "ny", "nz"});
    auto uv = columns({"u", "v"});
    if (uv.empty()) uv = columns({"s", "t"});
    auto attributes = find_ply_attributes(element, "vertex_");

    mesh_.positions.reserve(element.count);
    if (!normal.empty()) mesh_.normals.reserve(element.count);
    if (!uv.empty()) mesh_.uvs.reserve(element.count);
    for (uint64_t i = 0; i < element.count; ++i) {
      read_row(element, -1, [](double) {});
      for (const double value : row_)
        if (!std::isfinite(static_cast<float>(value)))
          source_.fail(fmt::format("vertex {} holds {}", i, value));
      const auto at = [&](const std::vector<int>& of, size_t k) { return row_[static_cast<size_t>(of[k])]; };
      mesh_.positions.emplace_back(at(position, 0), at(position, 1), at(position, 2));
      if (!uv.empty()) mesh_.uvs.emplace_back(at(uv, 0), flip_ ? 1 - at(uv, 1) : at(uv, 1));
      if (!normal.empty()) {
        const dvec3 n(at(normal, 0), at(normal, 1), at(normal, 2));
        const double length = glm::length(n);
        mesh_.normals.emplace_back(length > 0 ? n / length : dvec3(0));
      }
      for (PlyAttribute& attribute : attributes) append_row(attribute, element, row_);
    }
    keep(attributes);
  }

  void read_faces(const PlyElement& element) {
    int list = element.find("vertex_indices");
    if (list < 0) list = element.find("vertex_index");
    if (list < 0 || !element.properties[static_cast<size_t>(list)].is_list)
      throw InputError(element.where, "element face lacks the list vertex_indices");
    auto attributes = find_ply_attributes(element, "face_");
    mesh_.triangles.reserve(element.count);
    for (uint64_t i = 0; i < element.count; ++i) {
      const size_t first_triangle = mesh_.triangles.size();
      glm::uvec3 fan{0};
      uint64_t corners = 0;
      read_row(element, list, [&](double index) {
        if (!(index >= 0 && index < vertex_count_))
          source_.fail(fmt::format("face {} refers to vertex {}, but there are {}", i, index, vertex_count_));
        const auto vertex = static_cast<uint32_t>(index);
        if (corners == 0) fan.x = vertex;
        fan.y = fan.z;
        fan.z = vertex;
        if (++corners >= 3) mesh_.triangles.push_back(fan);
      });
      if (corners < 3) source_.fail(fmt::format("face {} has {} corners, expected at least 3", i, corners));
      for (size_t t = first_triangle; t < mesh_.triangles.size(); ++t)
        for (PlyAttribute& attribute : attributes) append_row(attribute, element, row_);
    }
    keep(attributes);
  }

  void keep(std::vector<PlyAttribute>& attributes) {
    for (PlyAttribute& found : attributes) {
      for (const float value : found.attribute.values)
        if (!std::isfinite(value))
          source_.fail(fmt::format("attribute {} holds {}", found.attribute.name, value));
      mesh_.attributes.push_back(std::move(found.attribute));
    }
  }

  Source source_;
  const PlyHeader& header_;
  bool flip_, skip_normals_;
  uint32_t vertex_count_ = 0;
  std::vector<double> row_;  // of the element being read; entries of lists are left out
  Mesh mesh_;
};

}  // namespace

Mesh read_ply(const std::filesystem::path& file, bool flip_tex_coords, bool skip_normals) {
  const FileBytes bytes = read_file(file);
  TextCursor cursor(bytes.view(), locate_file(file));
  const PlyHeader header = read_ply_header(cursor);
  const auto read = [&](auto source) {
    return PlyReader(std::move(source), header, flip_tex_coords, skip_normals).read();
  };
  switch (header.format) {
    case PlyHeader::Format::kAscii:
      return read(AsciiSource(cursor));
    case PlyHeader::Format::kLittleEndian:
      return read(BinarySource<false>(cursor));
    case PlyHeader::Format::kBigEndian:
      return read(BinarySource<true>(cursor));
  }
  return {};
}

}  // namespace tachylite
