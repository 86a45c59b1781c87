// PLY (Turk 1994, "The PLY polygon file format"), ASCII and binary of both byte orders.

#include <algorithm>
#include <bit>
#include <cstring>
#include <exception>
#include <limits>

#include "base/parallel.h"
#include "base/read_file.h"
#include "scene/load_mesh.h"
#include "scene/ply_attributes.h"
#include "scene/ply_header.h"
#include "scene/split_text.h"

namespace tachylite {
namespace {

static_assert(std::endian::native == std::endian::little);

/// One that does not end counts, too.
size_t count_lines(std::string_view text) {
  constexpr size_t kAtOnce = 128;  // whose number fits into a byte, so that the loop becomes vectors of bytes
  size_t lines = !text.empty() && text.back() != '\n';
  for (; !text.empty(); text.remove_prefix(std::min(kAtOnce, text.size()))) {
    uint8_t some = 0;
    for (const char c : text.substr(0, kAtOnce)) some = static_cast<uint8_t>(some + (c == '\n'));
    lines += some;
  }
  return lines;
}

/// Some consecutive rows of an element, and where they begin.
template <typename Source>
struct Rows {
  Source source;
  uint64_t first, last;
};

/// Numbers of a text file, wherever its lines end.
class AsciiSource {
 public:
  explicit AsciiSource(const TextCursor& cursor) : cursor_(cursor) {}

  double next(PlyType type) {
    cursor_.skip_space();
    if (cursor_.at_end()) cursor_.fail("the file is cut short");
    const double largest = largest_integer(type);
    const double value = largest > 0 ? static_cast<double>(cursor_.integer()) : cursor_.real("number");
    if (largest > 0 && (value > largest || value < -largest - 1))
      cursor_.fail("a number does not fit into its type");
    return value;
  }
  [[noreturn]] void fail(const std::string& message) const { cursor_.fail(message); }

  /// Parts of the element's rows, on the guess that each row stands on a line of its own; goes_on_at tells.
  std::vector<Rows<AsciiSource>> split(const PlyElement& element) const {
    const std::vector<std::string_view> parts = split_text(cursor_.rest());
    std::vector<size_t> lines(parts.size());
    parallel_for_each(parts.size(), [&](size_t i) { lines[i] = count_lines(parts[i]); });
    std::vector<Rows<AsciiSource>> rows;
    FileLocation where = cursor_.where();
    std::string_view rest = cursor_.rest();
    uint64_t row = 0;
    for (size_t i = 0; i < parts.size() && row < element.count; ++i) {
      const uint64_t last = std::min<uint64_t>(element.count, row + lines[i]);
      rows.push_back({AsciiSource(TextCursor(rest, where)), row, last});
      rest.remove_prefix(parts[i].size());
      where.line += static_cast<int>(lines[i]);
      row = last;
    }
    if (row < element.count) return {{*this, 0, element.count}};
    return rows;
  }
  /// Nothing lies between here and `next`.
  bool goes_on_at(const AsciiSource& next) const {
    TextCursor here = cursor_, there = next.cursor_;
    here.skip_space();
    there.skip_space();
    return here.rest().data() == there.rest().data();
  }

 private:
  TextCursor cursor_;
};

template <bool kSwap>
class BinarySource {
 public:
  explicit BinarySource(const TextCursor& cursor)
      : at_(cursor.rest().data()), end_(at_ + cursor.rest().size()), where_(cursor.where()) {
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

  /// Parts of the element's rows. Where the file is broken, or cut short, the last part begins before that.
  std::vector<Rows<BinarySource>> split(const PlyElement& element) const {
    constexpr uint64_t kRowsAtOnce = 8192;
    std::vector<Rows<BinarySource>> rows;
    BinarySource at = *this;
    for (uint64_t row = 0; row < element.count; row += kRowsAtOnce) {
      rows.push_back({at, row, std::min(row + kRowsAtOnce, element.count)});
      if (at.skip_rows(element, rows.back().last - row)) continue;
      rows.back().last = element.count;
      break;
    }
    return rows;
  }
  bool goes_on_at(const BinarySource& next) const { return at_ == next.at_; }

 private:
  /// False where they do not end.
  bool skip_rows(const PlyElement& element, uint64_t count) {
    size_t fixed_bytes = 0;
    bool has_list = false;
    for (const PlyProperty& property : element.properties) {
      has_list = has_list || property.is_list;
      fixed_bytes += property.is_list ? 0 : byte_size(property.type);
    }
    if (!has_list) return skip(count * fixed_bytes);  // no overflow: the header was compared with the file's size
    for (; count > 0; --count)
      for (const PlyProperty& property : element.properties) {
        if (!property.is_list) {
          if (!skip(byte_size(property.type))) return false;
          continue;
        }
        if (left() < byte_size(property.count_type)) return false;
        const double length = next(property.count_type);
        if (length < 0 || !skip(static_cast<size_t>(length) * byte_size(property.type))) return false;
      }
    return true;
  }
  bool skip(size_t bytes) {
    if (left() < bytes) return false;
    at_ += bytes;
    return true;
  }
  size_t left() const { return static_cast<size_t>(end_ - at_); }

  template <typename T>
  T take() {
    if (left() < sizeof(T)) fail("the file is cut short");
    char bytes[sizeof(T)];
    std::memcpy(bytes, at_, sizeof(T));
    if (kSwap) std::reverse(bytes, bytes + sizeof(T));
    at_ += sizeof(T);
    return std::bit_cast<T>(bytes);
  }
  const char *at_, *end_;
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
        read_rows(element, {}, [&](RowReader& row, Part&) { row.read(); });
      }
    }
    return std::move(mesh_);
  }

 private:
  /// What some rows add to the mesh.
  struct Part {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> uvs;
    std::vector<glm::uvec3> triangles;
    std::vector<PlyAttribute> attributes;
  };

  class RowReader {
   public:
    RowReader(const Source& begin, const PlyElement& element)
        : source(begin), values(element.properties.size()), element_(element) {}

    /// Reads one row; the entries of list number `list` go to `on_entry`.
    template <typename OnEntry>
    void read(int list, const OnEntry& on_entry) {
      for (size_t i = 0; i < values.size(); ++i) {
        const PlyProperty& property = element_.properties[i];
        if (!property.is_list) {
          values[i] = source.next(property.type);
          continue;
        }
        const double length = source.next(property.count_type);
        if (length < 0) source.fail("a list has a negative length");
        for (auto left = static_cast<uint64_t>(length); left > 0; --left) {
          const double entry = source.next(property.type);
          if (static_cast<int>(i) == list) on_entry(entry);
        }
      }
    }
    void read() {
      read(-1, [](double) {});
    }

    Source source;
    uint64_t number = 0;
    std::vector<double> values;  // lists are left out

   private:
    const PlyElement& element_;
  };

  /// Calls read_row(RowReader&, Part&) for each row, many at a time, and adds all parts to the mesh in their order.
  template <typename ReadRow>
  void read_rows(const PlyElement& element, const std::vector<PlyAttribute>& attributes, const ReadRow& read_row) {
    std::vector<Rows<Source>> rows = source_.split(element);
    if (rows.empty()) return keep(attributes);
    std::vector<Part> parts = read_parts(rows, element, attributes, read_row);
    if (parts.empty()) {
      // The rows begin elsewhere than was guessed.
      rows = {{source_, 0, element.count}};
      parts = read_parts(rows, element, attributes, read_row);
    }
    source_ = rows.back().source;
    std::vector<PlyAttribute> all = attributes;
    const auto append = [&](auto& to, auto Part::* of) {
      size_t size = to.size();
      for (const Part& part : parts) size += (part.*of).size();
      to.reserve(size);
      for (const Part& part : parts) to.insert(to.end(), (part.*of).begin(), (part.*of).end());
    };
    append(mesh_.positions, &Part::positions);
    append(mesh_.normals, &Part::normals);
    append(mesh_.uvs, &Part::uvs);
    append(mesh_.triangles, &Part::triangles);
    for (size_t i = 0; i < all.size(); ++i)
      for (const Part& part : parts) {
        const std::vector<float>& values = part.attributes[i].attribute.values;
        all[i].attribute.values.insert(all[i].attribute.values.end(), values.begin(), values.end());
      }
    keep(std::move(all));
  }

  /// Moves `rows` to where they end. Nothing, if one does not end where the next begins.
  template <typename ReadRow>
  std::vector<Part> read_parts(std::vector<Rows<Source>>& rows, const PlyElement& element,
                               const std::vector<PlyAttribute>& attributes, const ReadRow& read_row) {
    std::vector<Part> parts(rows.size());
    std::vector<std::exception_ptr> failures(rows.size());
    const std::vector<Rows<Source>> begins = rows;
    parallel_for_each(rows.size(), [&](size_t i) {
      try {
        parts[i].attributes = attributes;
        RowReader row(rows[i].source, element);
        for (row.number = rows[i].first; row.number < rows[i].last; ++row.number) read_row(row, parts[i]);
        rows[i].source = row.source;
      } catch (...) {
        failures[i] = std::current_exception();
      }
    });
    // A part's complaint counts if it began at its first row.
    for (size_t i = 0; i < rows.size(); ++i) {
      if (failures[i]) std::rethrow_exception(failures[i]);
      if (i + 1 < rows.size() && !rows[i].source.goes_on_at(begins[i + 1].source)) return {};
    }
    return parts;
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

    read_rows(element, find_ply_attributes(element, "vertex_"), [&](RowReader& row, Part& part) {
      row.read();
      for (const double value : row.values)
        if (!std::isfinite(static_cast<float>(value)))
          row.source.fail(fmt::format("vertex {} holds {}", row.number, value));
      const auto at = [&](const std::vector<int>& of, size_t k) { return row.values[static_cast<size_t>(of[k])]; };
      part.positions.emplace_back(at(position, 0), at(position, 1), at(position, 2));
      if (!uv.empty()) part.uvs.emplace_back(at(uv, 0), flip_ ? 1 - at(uv, 1) : at(uv, 1));
      if (!normal.empty()) {
        const dvec3 n(at(normal, 0), at(normal, 1), at(normal, 2));
        const double length = glm::length(n);
        part.normals.emplace_back(length > 0 ? n / length : dvec3(0));
      }
      for (PlyAttribute& attribute : part.attributes) append_row(attribute, element, row.values);
    });
  }

  void read_faces(const PlyElement& element) {
    int list = element.find("vertex_indices");
    if (list < 0) list = element.find("vertex_index");
    if (list < 0 || !element.properties[static_cast<size_t>(list)].is_list)
      throw InputError(element.where, "element face lacks the list vertex_indices");
    read_rows(element, find_ply_attributes(element, "face_"), [&](RowReader& row, Part& part) {
      const size_t first_triangle = part.triangles.size();
      glm::uvec3 fan{0};
      uint64_t corners = 0;
      row.read(list, [&](double index) {
        if (!(index >= 0 && index < vertex_count_))
          row.source.fail(
              fmt::format("face {} refers to vertex {}, but there are {}", row.number, index, vertex_count_));
        const auto vertex = static_cast<uint32_t>(index);
        if (corners == 0) fan.x = vertex;
        fan.y = fan.z;
        fan.z = vertex;
        if (++corners >= 3) part.triangles.push_back(fan);
      });
      if (corners < 3) row.source.fail(fmt::format("face {} has {} corners, expected at least 3", row.number, corners));
      for (size_t t = first_triangle; t < part.triangles.size(); ++t)
        for (PlyAttribute& attribute : part.attributes) append_row(attribute, element, row.values);
    });
  }

  void keep(std::vector<PlyAttribute> attributes) {
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
