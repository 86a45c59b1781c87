// Wavefront OBJ. Own code, as tinyobjloader takes 0 for a number that does not parse, and cuts quads along
// the shorter diagonal where Mitsuba takes a fan.

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "base/parallel.h"
#include "base/read_file.h"
#include "scene/load_mesh.h"
#include "scene/split_text.h"
#include "scene/text_cursor.h"

namespace tachylite {
namespace {

constexpr int kLongList = 64;
constexpr uint32_t kAbsent = std::numeric_limits<uint32_t>::max();

/// A place of the file: how many v, vt, vn stand before it, and its line.
struct ObjPlace {
  std::array<size_t, 3> counts{};
  int line = 1;
};

/// What the indices of faces refer to; filled by all parts, each at its own place.
struct ObjTables {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
};

/// Of the tables; kAbsent where the file names none.
struct ObjCorner {
  uint32_t position, uv, normal;
};

struct ObjFaces {
  std::vector<ObjCorner> corners;
  std::vector<uint32_t> sizes;  // corners of each face
};

/// Where a part would end that began with the file. Exact only as long as the part is right: a line that a face continues
/// might begin with v, which is an error.
ObjPlace find_end(std::string_view part, const FileLocation& file) {
  ObjPlace place;
  TextCursor cursor(part, {file.file, 1});
  for (; !cursor.at_end(); cursor.skip_line()) {
    if (cursor.at_line_end()) continue;
    const std::string_view keyword = cursor.word();
    if (keyword[0] != 'v' || keyword.size() > 2) continue;
    if (keyword == "v") ++place.counts[0];
    if (keyword == "vt") ++place.counts[1];
    if (keyword == "vn") ++place.counts[2];
  }
  place.line = cursor.where().line;
  return place;
}

/// Reads a part of the file, of which only its place must be known.
class ObjPartReader {
 public:
  ObjPartReader(std::string_view part, const ObjPlace& place, const FileLocation& file, bool flip_tex_coords,
                ObjTables& tables)
      : cursor_(part, {file.file, place.line}),
        counts_(place.counts),
        flip_tex_coords_(flip_tex_coords),
        tables_(tables) {}

  ObjFaces read() {
    for (; !cursor_.at_end(); cursor_.skip_line()) {
      if (cursor_.at_line_end()) continue;
      read_statement(cursor_.word());
    }
    return std::move(faces_);
  }

 private:
  void read_statement(std::string_view keyword) {
    if (keyword == "v") {
      const float x = cursor_.real("x"), y = cursor_.real("y");
      tables_.positions[counts_[0]] = {x, y, cursor_.real("z")};
      ++counts_[0];
    } else if (keyword == "vn") {
      const float x = cursor_.real("x"), y = cursor_.real("y");
      tables_.normals[counts_[2]] = unit_or_zero({x, y, cursor_.real("z")});
      ++counts_[2];
    } else if (keyword == "vt") {
      const float u = cursor_.real("u");
      const float v = cursor_.at_line_end() ? 0 : cursor_.real("v");
      tables_.uvs[counts_[1]] = {u, flip_tex_coords_ ? 1 - v : v};
      ++counts_[1];
    } else if (keyword == "f" || keyword == "fo") {
      read_face();
    } else if (keyword.starts_with('#') || is_ignored(keyword)) {
      return;
    } else {
      cursor_.fail(fmt::format("\"{:.30}\" is not supported in OBJ files", keyword));
    }
  }

  /// Names, materials, display attributes, points and lines.
  static bool is_ignored(std::string_view keyword) {
    for (const std::string_view known :
         {"o", "g", "s", "mg", "usemtl", "mtllib", "vp", "p", "l", "bevel", "c_interp", "d_interp", "lod",
          "usemap", "maplib", "shadow_obj", "trace_obj"})
      if (keyword == known) return true;
    return false;
  }

  static glm::vec3 unit_or_zero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0 ? glm::vec3(v / length) : glm::vec3(0);
  }

  void read_face() {
    uint32_t count = 0;
    for (; !cursor_.at_line_end(); ++count) faces_.corners.push_back(read_corner());
    if (count < 3) cursor_.fail(fmt::format("a face has {} corners, expected at least 3", count));
    faces_.sizes.push_back(count);
  }

  /// v, v/vt, v//vn or v/vt/vn
  ObjCorner read_corner() {
    std::string_view word = cursor_.word();
    const std::string_view whole = word;
    uint32_t index[3] = {kAbsent, kAbsent, kAbsent};
    constexpr const char* kNames[3] = {"vertex", "texture coordinate", "normal"};
    for (size_t i = 0; i < 3; ++i) {
      if (i > 0) {
        if (word.empty()) break;
        if (word[0] != '/') fail_corner(whole);
        word.remove_prefix(1);
        if (i == 1 && word.starts_with('/')) continue;
      }
      int64_t value = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc()) fail_corner(whole);
      word.remove_prefix(static_cast<size_t>(end - word.data()));
      const auto size = static_cast<int64_t>(counts_[i]);
      const int64_t absolute =
          value < 0 ? size + value : value - 1;  // negative ones count back from the last
      if (absolute < 0 || absolute >= size)
        cursor_.fail(fmt::format("face refers to {} {}, but {} are given before it", kNames[i], value, size));
      index[i] = static_cast<uint32_t>(absolute);
    }
    if (!word.empty()) fail_corner(whole);
    return {index[0], index[1], index[2]};
  }

  [[noreturn]] void fail_corner(std::string_view word) const {
    cursor_.fail(fmt::format("corner of a face is \"{:.30}\", expected v, v/vt, v//vn or v/vt/vn", word));
  }

  TextCursor cursor_;
  std::array<size_t, 3> counts_;
  bool flip_tex_coords_;
  ObjTables& tables_;
  ObjFaces faces_;
};

/// Makes the mesh's vertices of corners, numbered as the file first names them.
class ObjMeshBuilder {
 public:
  ObjMeshBuilder(const ObjTables& tables, const FileLocation& file, bool skip_normals)
      : tables_(tables), file_(file), skip_normals_(skip_normals), first_(tables.positions.size(), kAbsent) {}

  void add(const ObjFaces& faces) {
    const ObjCorner* corner = faces.corners.data();
    for (const uint32_t size : faces.sizes) {
      uint32_t ends[2]{};
      for (uint32_t i = 0; i < size; ++i, ++corner) {
        const uint32_t vertex = find_vertex(corner->position, corner->uv, skip_normals_ ? kAbsent : corner->normal);
        if (i >= 2) mesh_.triangles.emplace_back(ends[0], ends[1], vertex);
        ends[i == 0 ? 0 : 1] = vertex;
      }
    }
  }

  Mesh finish() {
    // Texture coordinates and normals are for all vertices or for none.
    mesh_.positions.resize(vertices_.size());
    if (any_uv_) mesh_.uvs.resize(vertices_.size());
    if (any_normal_) mesh_.normals.resize(vertices_.size());
    parallel_for(0, vertices_.size(), kMeshGrain, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) {
        const auto& [corner, next] = vertices_[i];
        mesh_.positions[i] = tables_.positions[corner.position];
        if (any_uv_ && corner.uv != kAbsent) mesh_.uvs[i] = tables_.uvs[corner.uv];
        if (any_normal_ && corner.normal != kAbsent) mesh_.normals[i] = tables_.normals[corner.normal];
      }
    });
    return std::move(mesh_);
  }

 private:
  /// The vertex with these three; vertices of one position form a list, and those beyond kLongList are in crowded_.
  uint32_t find_vertex(uint32_t position, uint32_t uv, uint32_t normal) {
    uint32_t* link = &first_[position];
    int length = 0;
    for (; *link != kAbsent && length < kLongList; ++length) {
      Vertex& vertex = vertices_[*link];
      if (vertex.corner.uv == uv && vertex.corner.normal == normal) return *link;
      link = &vertex.next;
    }
    if (length == kLongList) link = &crowded_.try_emplace({position, uv, normal}, kAbsent).first->second;
    if (*link != kAbsent) return *link;
    const auto vertex = static_cast<uint32_t>(vertices_.size());
    if (vertex == kAbsent) throw InputError(file_, "the mesh has too many vertices");
    *link = vertex;
    vertices_.push_back({{position, uv, normal}, kAbsent});
    any_uv_ = any_uv_ || uv != kAbsent;
    any_normal_ = any_normal_ || normal != kAbsent;
    return vertex;
  }

  struct Vertex {
    ObjCorner corner;
    uint32_t next;
  };

  const ObjTables& tables_;
  const FileLocation& file_;
  bool skip_normals_;
  std::vector<uint32_t> first_;  // of each position: its first vertex
  std::vector<Vertex> vertices_;
  std::map<std::array<uint32_t, 3>, uint32_t> crowded_;
  bool any_uv_ = false, any_normal_ = false;
  Mesh mesh_;
};

/// Where each part begins, and the last one ends.
std::vector<ObjPlace> find_places(const std::vector<std::string_view>& parts, const FileLocation& file) {
  std::vector<ObjPlace> places(parts.size() + 1);
  parallel_for_each(parts.size(), [&](size_t i) { places[i + 1] = find_end(parts[i], file); });
  for (size_t i = 1; i < places.size(); ++i) {
    places[i].line += places[i - 1].line - 1;
    for (size_t k = 0; k < 3; ++k) places[i].counts[k] += places[i - 1].counts[k];
  }
  return places;
}

}  // namespace

Mesh read_obj(const std::filesystem::path& file, bool flip_tex_coords, bool skip_normals) {
  const FileBytes bytes = read_file(file);
  const FileLocation where = locate_file(file);
  const std::vector<std::string_view> parts = split_text(bytes.view());
  const std::vector<ObjPlace> places = find_places(parts, where);
  ObjTables tables;
  const auto& [positions, uvs, normals] = places.back().counts;
  tables.positions.resize(positions);
  tables.uvs.resize(uvs);
  tables.normals.resize(normals);

  // Vertices are numbered in the order of the file, by one thread, while the others read what follows.
  constexpr size_t kPartsAtOnce = 64;
  ObjMeshBuilder builder(tables, where, skip_normals);
  std::vector<ObjFaces> read, unread;
  for (size_t first = 0; first < parts.size() || !read.empty(); first += kPartsAtOnce) {
    unread.resize(std::min(kPartsAtOnce, parts.size() - std::min(first, parts.size())));
    parallel_invoke(
        [&] {
          for (const ObjFaces& faces : read) builder.add(faces);
        },
        [&] {
          parallel_for_each(unread.size(), [&](size_t i) {
            unread[i] =
                ObjPartReader(parts[first + i], places[first + i], where, flip_tex_coords, tables).read();
          });
        });
    read = std::move(unread);
    unread.clear();
  }
  return builder.finish();
}

}  // namespace tachylite
