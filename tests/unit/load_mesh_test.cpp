#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/ranges.h>
#include <tiny_obj_loader.h>

#include "load_support.h"
#include "scene/load_mesh.h"

namespace tachylite {
namespace {

constexpr const char* kPlyHeader =
    "ply\nformat {} 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
    "double z\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float s\nproperty float t\n"
    "element edge 1\nproperty int a\nproperty list ushort short b\n"
    "element face 2\nproperty list uchar uint vertex_indices\nproperty float heat_0\nend_header\n";

class LoadMesh : public LoadTest {
 protected:
  Mesh obj(const std::string& text, bool flip = false, bool skip = false) const {
    return read_obj(write("mesh.obj", text), flip, skip);
  }
  std::string square(const char* format) const { return fmt::format(fmt::runtime(kPlyHeader), format); }

  static void expect_square(const Mesh& mesh) {
    ASSERT_EQ(mesh.positions.size(), 4);
    EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, 0.5f));
    EXPECT_EQ(mesh.uvs[3], glm::vec2(0, 0.25f));
    ASSERT_EQ(mesh.triangles.size(), 3);  // a quad cut as a fan, then a triangle
    EXPECT_EQ(mesh.triangles[0], glm::uvec3(0, 1, 2));
    EXPECT_EQ(mesh.triangles[1], glm::uvec3(0, 2, 3));
    EXPECT_EQ(mesh.triangles[2], glm::uvec3(2, 1, 0));
    ASSERT_EQ(mesh.attributes.size(), 2);
    EXPECT_EQ(mesh.attributes[0].name, "vertex_color");
    EXPECT_EQ(mesh.attributes[0].channels, 3);
    EXPECT_NEAR(mesh.attributes[0].values[3 + 1], 0.2158605f, 1e-6f);  // 128 of 255, decoded
    EXPECT_EQ(mesh.attributes[1].name, "face_heat");
    EXPECT_EQ(mesh.attributes[1].values, (std::vector<float>{7, 7, 9}));
  }
};

TEST_F(LoadMesh, ObjVerticesAreDistinctCombinations) {
  const Mesh mesh = obj(
      "# comment\nmtllib x.mtl\no thing\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\nvt 0 0.25\nvt 1\nvn 0 0 2\n"
      "f 1/1/1 2/2/1 3/1/1\r\nf 1/1/1 3/1/1 4/-2/-1\ns off\nf 1/2/1 \\\n 2/2/1 3/1/1\n");
  EXPECT_EQ(mesh.positions.size(), 5);
  EXPECT_EQ(mesh.triangles.size(), 3);
  EXPECT_EQ(mesh.triangles[1], glm::uvec3(0, 2, 3));
  EXPECT_EQ(mesh.triangles[2], glm::uvec3(4, 1, 2));
  EXPECT_EQ(mesh.uvs[3], glm::vec2(0, 0.25f));
  EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1));
}

TEST_F(LoadMesh, ObjFlipsAndSkips) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 0.25\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n";
  EXPECT_EQ(obj(text, true).uvs[0], glm::vec2(0.5f, 0.75f));
  EXPECT_TRUE(obj(text, false, true).normals.empty());
  EXPECT_TRUE(obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3").uvs.empty());
}

TEST_F(LoadMesh, ObjAgreesWithTinyobjloader) {
  // A bumpy grid with seams: triangles only, as tinyobjloader cuts quads otherwise.
  std::string text;
  constexpr int kSide = 12;
  for (int i = 0; i < kSide * kSide; ++i)
    text += fmt::format("v {} {} {:.6e}\nvt {} {}\nvn {} 0.5 1\n", i % kSide, i / kSide, 0.1 * (i % 5),
                        0.1 * (i % 7), 0.01 * i, 0.2 * (i % 3));
  for (int i = 0; i + kSide + 1 < kSide * kSide; ++i)
    text += fmt::format("f {0}/{1}/{2} {3}/{3}/{2} {4}/{1}/{4}\nf {4}//{1} {0}//{0} {3}//{1}\n", i + 1,
                        i % 9 + 1, i % 4 + 1, i + 2, i + kSide + 1);
  const Mesh mesh = obj(text);
  tinyobj::ObjReader oracle;
  ASSERT_TRUE(oracle.ParseFromFile((folder_ / "mesh.obj").string()));
  const auto& attrib = oracle.GetAttrib();
  const auto& indices = oracle.GetShapes().at(0).mesh.indices;
  ASSERT_EQ(indices.size(), 3 * mesh.triangles.size());
  for (size_t i = 0; i < indices.size(); ++i) {
    const uint32_t vertex = mesh.triangles[i / 3][static_cast<int>(i % 3)];
    const auto v = static_cast<size_t>(indices[i].vertex_index);
    for (size_t c = 0; c < 3; ++c)
      EXPECT_FLOAT_EQ(mesh.positions[vertex][static_cast<int>(c)], attrib.vertices[3 * v + c]);
    const int uv = indices[i].texcoord_index;
    EXPECT_FLOAT_EQ(mesh.uvs[vertex].x, uv < 0 ? 0 : attrib.texcoords[2 * static_cast<size_t>(uv)]);
    const float* n = &attrib.normals[3 * static_cast<size_t>(indices[i].normal_index)];
    EXPECT_NEAR(glm::length(mesh.normals[vertex] - glm::normalize(glm::vec3(n[0], n[1], n[2]))), 0, 1e-6);
  }
}

TEST_F(LoadMesh, PlyAscii) {
  const std::string text =
      square("ascii") +
      "0 0 0.5 0 0 0 0 0\n1 0 0.5 255 128 0 1 0\n1 1 0.5 0 0 0 1 1\n0 1 0.5 0 0 0 0 0.25\n"
      "3 2 5 6\n4 0 1 2 3 7\n3 2 1 0 9";
  expect_square(read_ply(write("mesh.ply", text), false, false));
  EXPECT_EQ(read_ply(folder_ / "mesh.ply", true, false).uvs[3], glm::vec2(0, 0.75f));
}

TEST_F(LoadMesh, PlyAttributesFollowTheRulesOfNaming) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 3\n";
  const std::vector<const char*> names = {
      "x",      "y",      "z",      "blue",   "green",  "red",   "quality", "flow_x", "flow_y", "flow_z",
      "tint_r", "tint_g", "tint_b", "pair_0", "pair_1", "wet_1", "odd_q",   "heat_0", "n_12",   "skip_y"};
  for (const char* name : names) text += fmt::format("property float {}\n", name);
  text += "element face 1\nproperty list uchar int vertex_index\nend_header\n";
  for (int i = 0; i < 3; ++i)
    for (size_t k = 0; k < names.size(); ++k) text += fmt::format("{} ", 100 * i + static_cast<int>(k));
  const Mesh mesh = read_ply(write("mesh.ply", text + "3 0 1 2"), false, false);
  std::string found;
  for (const MeshAttribute& attribute : mesh.attributes)
    found +=
        fmt::format("{}:{} ", attribute.name,
                    fmt::join(attribute.values.begin(), attribute.values.begin() + attribute.channels, ","));
  EXPECT_EQ(found,
            "vertex_color:5,4,3 vertex_flow:7,8,9 vertex_tint_color:10,11,12 vertex_wet:15 vertex_heat:17 ");
}

TEST_F(LoadMesh, PlyBinaryOfBothByteOrders) {
  for (const bool big : {false, true}) {
    std::string text = square(big ? "binary_big_endian" : "binary_little_endian");
    const auto put = [&](auto value) {
      char bytes[sizeof value];
      std::memcpy(bytes, &value, sizeof value);
      if (big) std::reverse(bytes, bytes + sizeof value);
      text.append(bytes, sizeof value);
    };
    for (int i = 0; i < 4; ++i) {
      put(i == 1 || i == 2 ? 1.0f : 0.0f);
      put(i >= 2 ? 1.0f : 0.0f);
      put(0.5);
      for (const int c : {255, 128, 0}) put(static_cast<uint8_t>(i == 1 ? c : 0));
      put(i == 1 || i == 2 ? 1.0f : 0.0f);
      put(i == 2 ? 1.0f : i == 3 ? 0.25f : 0.0f);
    }
    put(int32_t{3});
    put(uint16_t{2});
    put(int16_t{5});
    put(int16_t{6});
    put(uint8_t{4});
    for (const uint32_t i : {0, 1, 2, 3}) put(i);
    put(7.0f);
    put(uint8_t{3});
    for (const uint32_t i : {2, 1, 0}) put(i);
    put(9.0f);
    expect_square(read_ply(write("mesh.ply", text), false, false));
    EXPECT_THROW(read_ply(write("mesh.ply", text.substr(0, text.size() - 1)), false, false), InputError);
  }
}

// Files of many parts, which are read at the same time: strips of quads above each other, a row of vertices, then the
// row's faces.
class LoadLargeMesh : public LoadMesh {
 protected:
  static constexpr int kRows = 250, kColumns = 200;  // of vertices

  static Mesh expected() {
    Mesh mesh;
    for (int i = 0; i < kRows; ++i)
      for (int j = 0; j < kColumns; ++j) mesh.positions.emplace_back(j, i, 0.25f * static_cast<float>((i * j) % 7));
    for (uint32_t i = 0; i + 1 < kRows; ++i)
      for (uint32_t j = 0; j + 1 < kColumns; ++j) {
        const uint32_t a = i * kColumns + j, b = a + 1, c = b + kColumns, d = a + kColumns;
        mesh.triangles.emplace_back(a, b, c);
        if (is_quad(i, j)) mesh.triangles.emplace_back(a, c, d);
      }
    return mesh;
  }
  static bool is_quad(uint32_t i, uint32_t j) { return (i + j) % 3 != 0; }
  static uint64_t faces() { return uint64_t{kRows - 1} * (kColumns - 1); }

  static std::string face(uint32_t i, uint32_t j, const char* triangle, const char* quad) {
    const uint32_t a = i * kColumns + j;
    return fmt::format(fmt::runtime(is_quad(i, j) ? quad : triangle), a, a + 1, a + 1 + kColumns, a + kColumns);
  }
  static std::string header(const char* format) {
    return fmt::format("ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
                       "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                       format, kRows * kColumns, faces());
  }
  /// `between` stands between the words of a row, `after` ends every row.
  static std::string ascii(const char* between, const char* after) {
    std::string text = header("ascii");
    for (const glm::vec3& p : expected().positions)
      text += fmt::format("{1}{0}{2}{0}{3}{4}", between, p.x, p.y, p.z, after);
    for (uint32_t i = 0; i + 1 < kRows; ++i)
      for (uint32_t j = 0; j + 1 < kColumns; ++j) text += face(i, j, "3 {0} {1} {2}", "4 {} {} {} {}") + after;
    return text;
  }
  static std::string binary() {
    std::string bytes = header("binary_little_endian");
    const auto add = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    for (const glm::vec3& p : expected().positions) add(p);
    for (uint32_t i = 0; i + 1 < kRows; ++i)
      for (uint32_t j = 0; j + 1 < kColumns; ++j) {
        const uint32_t a = i * kColumns + j;
        add(static_cast<uint8_t>(is_quad(i, j) ? 4 : 3));
        add(glm::uvec3(a, a + 1, a + 1 + kColumns));
        if (is_quad(i, j)) add(a + kColumns);
      }
    return bytes;
  }
  static std::string obj_text() {
    std::string text = "# strips\n";
    for (uint32_t i = 0; i < kRows; ++i) {
      for (int j = 0; j < kColumns; ++j) {
        const glm::vec3 p = expected_position(i, j);
        text += fmt::format("v {} \\\n {} {}\r\n", p.x, p.y, p.z);  // lines may be continued
      }
      for (uint32_t j = 0; i > 0 && j + 1 < kColumns; ++j) {
        // Counted from the last vertex, or from the first.
        const int a = static_cast<int>(j) - 2 * kColumns, d = static_cast<int>(j) - kColumns;
        if (j % 2 == 0)
          text += fmt::format("f {} {} {}", a, a + 1, d + 1) + (is_quad(i - 1, j) ? fmt::format(" {}\n", d) : "\n");
        else
          text += obj_face(i - 1, j);
      }
    }
    return text;
  }
  static glm::vec3 expected_position(uint32_t i, int j) {
    static const Mesh mesh = expected();
    return mesh.positions[i * kColumns + static_cast<uint32_t>(j)];
  }
  static std::string obj_face(uint32_t i, uint32_t j) {
    const uint32_t a = i * kColumns + j + 1;
    return fmt::format("f {} {} {}", a, a + 1, a + 1 + kColumns) +
           (is_quad(i, j) ? fmt::format(" {}\n", a + kColumns) : "\n");
  }

  void expect_mesh(const Mesh& mesh) const {
    EXPECT_TRUE(mesh.positions == expected().positions);
    EXPECT_TRUE(mesh.triangles == expected().triangles);
  }
  Mesh ply(const std::string& bytes) const { return read_ply(write("mesh.ply", bytes), false, false); }
  template <typename Read>
  static std::string complaint_of(const Read& read) {
    try {
      read();
    } catch (const InputError& error) {
      const std::string message = error.what();
      return message.substr(message.rfind('/') + 1);
    }
    return "";
  }
  static size_t line_of(const std::string& text, size_t at) {
    return 1 + static_cast<size_t>(std::count(text.begin(), text.begin() + static_cast<ptrdiff_t>(at), '\n'));
  }
};

TEST_F(LoadLargeMesh, ObjInParts) {
  const std::string text = obj_text();
  ASSERT_GT(text.size(), size_t{1} << 20);  // several parts
  const Mesh mesh = obj(text);
  ASSERT_EQ(mesh.positions.size(), expected().positions.size());
  ASSERT_EQ(mesh.triangles.size(), expected().triangles.size());
  // Vertices are numbered as faces name them: compare corners.
  const Mesh wanted = expected();
  size_t different = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      different += mesh.positions[mesh.triangles[t][k]] != wanted.positions[wanted.triangles[t][k]];
  EXPECT_EQ(different, 0);
  uint32_t next = 0;
  for (const glm::uvec3& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      ASSERT_LE(triangle[k], next);
      if (triangle[k] == next) ++next;
    }
}

TEST_F(LoadLargeMesh, ObjComplaintIsTheFirst) {
  for (const double place : {0.2, 0.5, 0.9}) {
    std::string text = obj_text();
    const auto at = [&](double share) {
      return text.find("\nf ", static_cast<size_t>(share * static_cast<double>(text.size()))) + 1;
    };
    text.insert(at(0.95), "f 1 2 x\nv 1\nunknown\n");
    const size_t wrong = at(place);
    const auto given = std::count(text.begin(), text.begin() + static_cast<ptrdiff_t>(wrong), 'v');
    text.insert(wrong, "f 1 2 1000000\n");
    EXPECT_EQ(complaint_of([&] { obj(text); }),
              fmt::format("mesh.obj:{}: face refers to vertex 1000000, but {} are given before it",
                          line_of(text, wrong), given));
  }
}

TEST_F(LoadLargeMesh, PlyInParts) {
  ASSERT_GT(ascii(" ", "\n").size(), size_t{1} << 20);
  expect_mesh(ply(ascii(" ", "\n")));
  expect_mesh(ply(ascii(" ", "\n\n")));
  expect_mesh(ply(ascii("\n", "\n")));  // rows are not lines
  expect_mesh(ply(ascii(" ", " ")));
  expect_mesh(ply(binary()));
}

TEST_F(LoadLargeMesh, PlyComplaintIsTheFirst) {
  for (const char* after : {"\n", "\n\n"}) {
    std::string text = ascii(" ", after);
    for (const double place : {0.95, 0.8, 0.5}) {  // the last row to be spoiled is the first
      const size_t wrong = text.find("\n3 ", static_cast<size_t>(place * static_cast<double>(text.size()))) + 1;
      text.replace(wrong, 2, "3 -");
      const std::string words = complaint_of([&] { ply(text); });
      EXPECT_TRUE(words.starts_with(fmt::format("mesh.ply:{}: face ", line_of(text, wrong)))) << words;
    }
  }
  std::string bytes = binary();
  constexpr uint32_t kTooLarge = 1u << 30;
  const auto spoil = [&](size_t from_end) { std::memcpy(&bytes[bytes.size() - from_end], &kTooLarge, 4); };
  spoil(4);
  EXPECT_EQ(complaint_of([&] { ply(bytes); }),
            fmt::format("mesh.ply: face {} refers to vertex {}, but there are {}", faces() - 1, kTooLarge,
                        kRows * kColumns));
  bytes.resize(bytes.size() - 1);
  EXPECT_EQ(complaint_of([&] { ply(bytes); }), "mesh.ply: the file is cut short");
  spoil(40 * (kColumns - 1) * 13);  // an index or a length; all else is wrong from there
  EXPECT_TRUE(complaint_of([&] { ply(bytes); }).starts_with("mesh.ply: face "));
}

TEST_F(LoadMesh, NormalsAreWeightedByAngle) {
  // Three faces of a cube around a corner, one of them cut in two: the mean must not favour it.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 3, 3}};
  mesh.triangles = {{0, 4, 1}, {0, 2, 4}, {0, 1, 3}, {0, 3, 2}};
  compute_normals(mesh, {});
  expect_near(mesh.normals[0], -dvec3(1, 1, 1) / std::sqrt(3.0), 1e-7);
  EXPECT_EQ(mesh.normals[4], glm::vec3(0, 0, -1));
  EXPECT_EQ(glm::length(mesh.normals[5]), 1);  // of no triangle
}

TEST_F(LoadMesh, NormalsAreThoseOfTheWorld) {
  // Angles change under a stretch, and normals turn under a mirror: n_world = M^-T n_object must be what one
  // gets from the moved vertices.
  const dmat3 to_world{{3, 0, 0}, {0, 1, 0}, {0.5, 0, -1}};
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0.25f}, {0, 1, 0}, {-1, -1, 0.5f}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
  Mesh moved = mesh;
  for (glm::vec3& p : moved.positions) p = glm::vec3(to_world * dvec3(p));
  compute_normals(mesh, to_world);
  compute_normals(moved, {});
  for (size_t i = 0; i < 4; ++i)
    expect_near(glm::normalize(glm::inverse(glm::transpose(to_world)) * dvec3(mesh.normals[i])),
                dvec3(moved.normals[i]), 1e-6);
}

TEST_F(LoadMesh, MissingNormalsOnly) {
  const Mesh mesh = *load_mesh({write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nf 1//1 2 3\n"),
                                MeshRequest::Format::kObj,
                                true,
                                false,
                                {}});
  EXPECT_EQ(mesh.normals[0], glm::vec3(1, 0, 0));
  EXPECT_EQ(mesh.normals[1], glm::vec3(0, 0, 1));
}

TEST_F(LoadMesh, ShapesShareWhatTheyCan) {
  write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto shape = [](const char* operation) {
    return fmt::format(
        "<shape type=\"obj\"><string name=\"filename\" value=\"mesh.obj\"/>"
        "<transform name=\"to_world\">{}</transform></shape>",
        operation);
  };
  const Scene scene =
      load_body(shape("") + shape("<rotate x=\"1\" angle=\"30\"/>") + shape("<scale x=\"3\"/>"));
  const auto mesh = [&](size_t i) { return std::get<MeshShape>(scene.shapes[i].kind).mesh; };
  EXPECT_EQ(mesh(0), mesh(1));
  EXPECT_NE(mesh(0), mesh(2));  // its normals are weighted otherwise
}

}  // namespace
}  // namespace tachylite
