// Wavefront OBJ. Own code, as tinyobjloader takes 0 for a number that does not parse, and cuts quads along
// the shorter diagonal where Mitsuba takes a fan.

#include <array>
#include <limits>
#include <map>

#include "base/read_file.h"
#include "scene/load_mesh.h"
#include "scene/text_cursor.h"

namespace tachylite {
namespace {

constexpr int kLongList = 64;
constexpr uint32_t kAbsent = std::numeric_limits<uint32_t>::max();

class ObjReader {
 public:
  ObjReader(std::string_view text, const FileLocation& file, bool flip_tex_coords, bool skip_normals)
      : cursor_(text, file), flip_tex_coords_(flip_tex_coords), skip_normals_(skip_normals) {}

  Mesh read() {
    for (; !cursor_.at_end(); cursor_.skip_line()) {
      if (cursor_.at_line_end()) continue;
      read_statement(cursor_.word());
    }
    // Texture coordinates and normals are for all vertices or for none.
    if (!any_uv_) mesh_.uvs.clear();
    if (!any_normal_) mesh_.normals.clear();
    return std::move(mesh_);
  }

 private:
  void read_statement(std::string_view keyword) {
    if (keyword == "v") {
      const float x = cursor_.real("x"), y = cursor_.real("y");
      positions_.emplace_back(x, y, cursor_.real("z"));
      first_.push_back(kAbsent);
    } else if (keyword == "vn") {
      const float x = cursor_.real("x"), y = cursor_.real("y");
      normals_.push_back(unit_or_zero({x, y, cursor_.real("z")}));
    } else if (keyword == "vt") {
      const float u = cursor_.real("u");
      const float v = cursor_.at_line_end() ? 0 : cursor_.real("v");
      uvs_.emplace_back(u, flip_tex_coords_ ? 1 - v : v);
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
    uint32_t corners[2]{};
    size_t count = 0;
    for (; !cursor_.at_line_end(); ++count) {
      const uint32_t vertex = read_corner();
      if (count >= 2) mesh_.triangles.emplace_back(corners[0], corners[1], vertex);
      corners[count == 0 ? 0 : 1] = vertex;
    }
    if (count < 3) cursor_.fail(fmt::format("a face has {} corners, expected at least 3", count));
  }

  /// v, v/vt, v//vn or v/vt/vn
  uint32_t read_corner() {
    std::string_view word = cursor_.word();
    const std::string_view whole = word;
    uint32_t index[3] = {kAbsent, kAbsent, kAbsent};
    const size_t sizes[3] = {positions_.size(), uvs_.size(), normals_.size()};
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
      const auto size = static_cast<int64_t>(sizes[i]);
      const int64_t absolute =
          value < 0 ? size + value : value - 1;  // negative ones count back from the last
      if (absolute < 0 || absolute >= size)
        cursor_.fail(fmt::format("face refers to {} {}, but {} are given before it", kNames[i], value, size));
      index[i] = static_cast<uint32_t>(absolute);
    }
    if (!word.empty()) fail_corner(whole);
    return find_vertex(index[0], index[1], skip_normals_ ? kAbsent : index[2]);
  }

  [[noreturn]] void fail_corner(std::string_view word) const {
    cursor_.fail(fmt::format("corner of a face is \"{:.30}\", expected v, v/vt, v//vn or v/vt/vn", word));
  }

  /// The vertex with these three; vertices of one position form a list, and those beyond kLongList are in crowded_.
  uint32_t find_vertex(uint32_t position, uint32_t uv, uint32_t normal) {
    uint32_t* link = &first_[position];
    int length = 0;
    for (; *link != kAbsent && length < kLongList; ++length) {
      Binding& binding = bindings_[*link];
      if (binding.uv == uv && binding.normal == normal) return *link;
      link = &binding.next;
    }
    if (length == kLongList) link = &crowded_.try_emplace({position, uv, normal}, kAbsent).first->second;
    if (*link != kAbsent) return *link;
    const auto vertex = static_cast<uint32_t>(bindings_.size());
    if (vertex == kAbsent) cursor_.fail("the mesh has too many vertices");
    *link = vertex;
    bindings_.push_back({uv, normal, kAbsent});
    mesh_.positions.push_back(positions_[position]);
    mesh_.uvs.push_back(uv == kAbsent ? glm::vec2(0) : uvs_[uv]);
    mesh_.normals.push_back(normal == kAbsent ? glm::vec3(0) : normals_[normal]);
    any_uv_ = any_uv_ || uv != kAbsent;
    any_normal_ = any_normal_ || normal != kAbsent;
    return vertex;
  }

  struct Binding {
    uint32_t uv, normal, next;
  };

  TextCursor cursor_;
  bool flip_tex_coords_, skip_normals_;
  std::vector<glm::vec3> positions_, normals_;
  std::vector<glm::vec2> uvs_;
  std::vector<uint32_t> first_;    // of each position: its first vertex
  std::vector<Binding> bindings_;  // of each vertex
  std::map<std::array<uint32_t, 3>, uint32_t> crowded_;
  bool any_uv_ = false, any_normal_ = false;
  Mesh mesh_;
};

}  // namespace

Mesh read_obj(const std::filesystem::path& file, bool flip_tex_coords, bool skip_normals) {
  const FileBytes bytes = read_file(file);
  return ObjReader(bytes.view(), locate_file(file), flip_tex_coords, skip_normals).read();
}

}  // namespace tachylite
