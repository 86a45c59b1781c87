#include "measure/scaling_scenes.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/glm.hpp>

#include "base/check.h"
#include "base/error.h"
#include "base/pi.h"

namespace tachylite {
namespace {


const char* const kMaterials[] = {
    R"(<bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.4, 0.3"/></bsdf>)",
    R"(<bsdf type="roughconductor"><float name="alpha" value="0.2"/></bsdf>)",
    R"(<bsdf type="dielectric"/>)",
    R"(<bsdf type="plastic"><rgb name="diffuse_reflectance" value="0.2, 0.4, 0.7"/></bsdf>)",
    R"(<bsdf type="conductor"/>)",
    R"(<bsdf type="roughplastic"><float name="alpha" value="0.1"/></bsdf>)",
    R"(<bsdf type="roughdielectric"><float name="alpha" value="0.1"/></bsdf>)",
    R"(<bsdf type="principled"><rgb name="base_color" value="0.3, 0.6, 0.3"/><float name="roughness" value="0.4"/></bsdf>)"};

void write_file(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw RenderError(fmt::format("cannot write {}", file.string()));
}

std::string room(int max_depth, int size, bool light, const std::string& contents) {
  std::string walls;
  for (const char* wall : {R"(<rotate x="1" angle="-90"/><translate y="-1"/>)", R"(<rotate x="1" angle="90"/><translate y="1"/>)",
                           R"(<translate z="-1"/>)", R"(<rotate y="1" angle="-90"/><translate x="1"/>)",
                           R"(<rotate y="1" angle="90"/><translate x="-1"/>)", R"(<rotate y="1" angle="180"/><translate z="1"/>)"})
    walls += fmt::format(R"(<shape type="rectangle"><transform name="to_world">{}</transform>
  <bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.68, 0.65"/></bsdf></shape>)", wall);
  if (light)
    walls += R"(<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/><scale value="0.25"/>
  <translate y="0.99"/></transform><emitter type="area"><rgb name="radiance" value="12, 11, 10"/></emitter></shape>)";
  return fmt::format(R"(<scene version="3.0.0">
<integrator type="path"><integer name="max_depth" value="{}"/><integer name="rr_depth" value="100000"/></integrator>
<sensor type="perspective"><float name="fov" value="80"/>
  <transform name="to_world"><lookat origin="0, 0.1, 0.95" target="0, -0.1, 0" up="0, 1, 0"/></transform>
  <film type="hdrfilm"><integer name="width" value="{}"/><integer name="height" value="{}"/><rfilter type="box"/></film>
</sensor>
{}
{}
</scene>
)", max_depth, size, size, walls, contents);
}

struct FileMesh {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::ivec3> triangles;
};

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void write_ply(const std::filesystem::path& file, const FileMesh& mesh) {
  std::string bytes = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.positions.size());
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) bytes += fmt::format("property float {}\n", name);
  bytes += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangles.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    append(bytes, mesh.positions[i]);
    append(bytes, mesh.normals[i]);
  }
  for (const glm::ivec3& t : mesh.triangles) {
    bytes += '\3';
    append(bytes, t);
  }
  write_file(file, bytes);
}

void write_obj(const std::filesystem::path& file, const FileMesh& mesh) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  for (const glm::vec3& p : mesh.positions) fmt::format_to(out, "v {:.7g} {:.7g} {:.7g}\n", p.x, p.y, p.z);
  for (const glm::vec3& n : mesh.normals) fmt::format_to(out, "vn {:.5f} {:.5f} {:.5f}\n", n.x, n.y, n.z);
  for (const glm::ivec3& t : mesh.triangles)
    fmt::format_to(out, "f {0}//{0} {1}//{1} {2}//{2}\n", t.x + 1, t.y + 1, t.z + 1);
  write_file(file, fmt::to_string(text));
}

/// Latitudes and longitudes of a sphere with bumps, 2 * rings * (2 * rings) triangles.
FileMesh bumpy_ball(uint64_t triangles) {
  const int rings = std::max(4, static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / 4))));
  const int sides = 2 * rings;
  FileMesh mesh;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j <= sides; ++j) {
      const double theta = kPi * (i + 0.001) / (rings + 0.002), phi = 2 * kPi * j / sides;
      const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      const double bump = 1 + 0.05 * std::sin(9 * d.x) * std::sin(11 * d.y + 1) * std::sin(8 * d.z + 2);
      mesh.positions.emplace_back(0.6 * bump * d);
      mesh.normals.emplace_back(d);
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sides; ++j) {
      const int a = i * (sides + 1) + j, b = a + sides + 1;
      mesh.triangles.emplace_back(a, a + 1, b + 1);
      mesh.triangles.emplace_back(a, b + 1, b);
    }
  return mesh;
}

std::filesystem::path write_scene(const std::filesystem::path& folder, const std::string& text) {
  write_file(folder / "scene.xml", text);
  return folder / "scene.xml";
}

}  // namespace

std::filesystem::path write_triangles_scene(const std::filesystem::path& folder, uint64_t triangles, MeshFormat format) {
  const FileMesh mesh = bumpy_ball(triangles);
  const bool ply = format == MeshFormat::kPly;
  if (ply) write_ply(folder / "ball.ply", mesh);
  else write_obj(folder / "ball.obj", mesh);
  return write_scene(folder, room(6, 256, true,
                                  fmt::format(R"(<shape type="{0}"><string name="filename" value="ball.{0}"/>
<transform name="to_world"><translate y="-0.3" z="-0.2"/></transform>{1}</shape>)", ply ? "ply" : "obj", kMaterials[0])));
}

std::filesystem::path write_lights_scene(const std::filesystem::path& folder, uint64_t lights) {
  FileMesh mesh;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-0.95f, 0.95f), around(-1, 1);
  const float size = 0.12f / std::sqrt(static_cast<float>(lights));
  for (uint64_t i = 0; i < lights; ++i) {
    const glm::vec3 centre(place(random), place(random), 0.8f * place(random) - 0.15f);
    const auto first = static_cast<int>(mesh.positions.size());
    for (int k = 0; k < 3; ++k) {
      mesh.positions.push_back(centre + size * glm::vec3(around(random), around(random), around(random)));
      mesh.normals.emplace_back(0, 1, 0);
    }
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  write_ply(folder / "lights.ply", mesh);
  return write_scene(folder, room(4, 256, false, R"(<shape type="ply"><string name="filename" value="lights.ply"/>
<boolean name="face_normals" value="true"/><emitter type="area"><rgb name="radiance" value="60, 55, 50"/></emitter></shape>)"));
}

std::filesystem::path write_room_scene(const std::filesystem::path& folder, int max_depth, int size) {
  return write_scene(folder, room(max_depth, size, true,
                                  R"(<shape type="cube"><transform name="to_world"><scale value="0.25"/><rotate y="1" angle="20"/>
<translate x="0.35" y="-0.749" z="0"/></transform><bsdf type="diffuse"/></shape>
<shape type="cube"><transform name="to_world"><scale x="0.25" y="0.5" z="0.25"/><rotate y="1" angle="-20"/>
<translate x="-0.35" y="-0.499" z="-0.4"/></transform><bsdf type="diffuse"/></shape>)"));
}

int most_material_classes() { return static_cast<int>(std::size(kMaterials)); }

std::filesystem::path write_materials_scene(const std::filesystem::path& folder, int classes) {
  CHECK_LE(classes, most_material_classes());
  std::string balls;
  for (int i = 0; i < most_material_classes(); ++i)  // the same balls whatever they are made of
    balls += fmt::format(R"(<shape type="sphere"><point name="center" value="{}, {}, {}"/><float name="radius" value="0.2"/>{}</shape>)",
                         -0.66 + 0.44 * (i % 4), -0.799, i < 4 ? -0.3 : 0.2, kMaterials[i % classes]);
  return write_scene(folder, room(6, 256, true, balls));
}

}  // namespace tachylite
