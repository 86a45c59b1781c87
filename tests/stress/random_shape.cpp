#include <bit>
#include <cmath>
#include <cstring>

#include "stress/random_scene.h"

namespace tachylite::test {
namespace {

struct SmallMesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec2> uvs;
  std::vector<glm::uvec3> triangles;
};

/// A ball of radius 1 in rings and segments whose corners lie off it by up to `bumps`. Its seam in uv is left open:
/// corners stand there twice, at equal places.
SmallMesh ball(RandomSource& random, int rings, int segments, double bumps) {
  SmallMesh mesh;
  for (int r = 0; r <= rings; ++r) {
    const double theta = M_PI * r / rings;
    const bool pole = r == 0 || r == rings;
    glm::dvec3 first{};
    double radius = random.uniform(1 - bumps, 1 + bumps);
    for (int s = 0; s <= segments; ++s) {
      if (s > 0 && !pole) radius = random.uniform(1 - bumps, 1 + bumps);
      const double phi = 2 * M_PI * (s % segments) / segments;
      glm::dvec3 p = radius * glm::dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      if (pole) p = radius * glm::dvec3(0, 0, r == 0 ? 1 : -1);
      if (s == 0) first = p;
      if (s == segments) p = first;
      mesh.positions.emplace_back(p);
      mesh.uvs.emplace_back(static_cast<double>(s) / segments, static_cast<double>(r) / rings);
    }
  }
  const auto at = [&](int r, int s) { return static_cast<uint32_t>(r * (segments + 1) + s); };
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < segments; ++s) {
      if (r > 0) mesh.triangles.emplace_back(at(r, s), at(r + 1, s), at(r, s + 1));
      if (r + 1 < rings) mesh.triangles.emplace_back(at(r + 1, s), at(r + 1, s + 1), at(r, s + 1));
    }
  return mesh;
}

std::string obj(const SmallMesh& mesh, bool normals, bool uvs) {
  std::string text;
  for (const glm::vec3& p : mesh.positions) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
  if (uvs)
    for (const glm::vec2& t : mesh.uvs) text += fmt::format("vt {} {}\n", t.x, t.y);
  if (normals)
    for (const glm::vec3& p : mesh.positions) text += fmt::format("vn {} {} {}\n", p.x, p.y, p.z);
  for (const glm::uvec3& t : mesh.triangles) {
    text += "f";
    for (int i = 0; i < 3; ++i) {
      const uint32_t v = t[i] + 1;
      text += normals ? (uvs ? fmt::format(" {0}/{0}/{0}", v) : fmt::format(" {0}//{0}", v))
                      : (uvs ? fmt::format(" {0}/{0}", v) : fmt::format(" {}", v));
    }
    text += "\n";
  }
  return text;
}

/// Binary, of this machine's byte order.
std::string ply(const SmallMesh& mesh, bool normals, bool uvs, const std::vector<glm::vec3>& colors) {
  std::string bytes = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.positions.size());
  std::vector<std::string> names = {"x", "y", "z"};
  if (normals) names.insert(names.end(), {"nx", "ny", "nz"});
  if (uvs) names.insert(names.end(), {"u", "v"});
  if (!colors.empty()) names.insert(names.end(), {"r", "g", "b"});
  for (const std::string& name : names) bytes += fmt::format("property float {}\n", name);
  bytes += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangles.size());
  const auto append = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    append(mesh.positions[i]);
    if (normals) append(glm::normalize(mesh.positions[i]));
    if (uvs) append(mesh.uvs[i]);
    if (!colors.empty()) append(colors[i]);
  }
  for (const glm::uvec3& t : mesh.triangles) {
    bytes += static_cast<char>(3);
    append(t);
  }
  return bytes;
}

Element mesh_shape(RandomSource& random, SceneText& scene, bool& attribute) {
  const int rings = random.number(2, 5), segments = random.number(3, 7);
  const SmallMesh mesh = ball(random, rings, segments, random.chance(0.5) ? 0.3 : 0.0);
  const bool normals = random.chance(0.5), uvs = random.chance(0.6), is_ply = random.chance(0.5);
  attribute = is_ply && random.chance(0.4);
  std::vector<glm::vec3> colors;
  if (attribute)
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
      const double r = random.uniform(0, 1), g = random.uniform(0, 1), b = random.uniform(0, 1);
      colors.emplace_back(r, g, b);
    }
  std::string name = fmt::format("mesh{}.{}", scene.files.size(), is_ply ? "ply" : "obj");
  scene.files.emplace_back(name, is_ply ? ply(mesh, normals, uvs, colors) : obj(mesh, normals, uvs));
  Element shape = plugin("shape", is_ply ? "ply" : "obj").add(word("filename", name));
  if (random.chance(0.3)) shape.add(boolean("face_normals", true));
  return shape;
}

Element operation(const char* tag, const glm::dvec3& v) {
  return {tag,
          {{"x", fmt::format("{:.5g}", v.x)}, {"y", fmt::format("{:.5g}", v.y)}, {"z", fmt::format("{:.5g}", v.z)}},
          {}};
}

}  // namespace

Element random_shape(RandomSource& random, SceneText& scene, const ShapeChoice& choice, bool& attribute) {
  attribute = false;
  const std::string kind = choice.closed ? random.pick({"sphere", "sphere", "cube", "mesh"})
                                         : random.pick({"sphere", "rectangle", "cube", "disk", "cylinder", "mesh", "mesh"});
  Element shape = kind == "mesh" ? mesh_shape(random, scene, attribute) : plugin("shape", kind);
  if (kind == "cylinder" && random.chance(0.5)) {
    shape.add({"point", {{"name", "p0"}, {"value", random.point(-0.5, 0)}}, {}});
    shape.add({"point", {{"name", "p1"}, {"value", random.point(0.1, 0.7)}}, {}});
    shape.add(real("radius", random.uniform(0.1, 0.6)));
  }
  Element place = {"transform", {{"name", "to_world"}}, {}};
  const bool even = kind == "sphere" || kind == "cylinder" || random.chance(0.6);
  const double size = random.log_uniform(choice.low, choice.high);
  const glm::dvec3 skew(random.uniform(0.4, 1), random.uniform(0.4, 1), random.uniform(0.4, 1));
  place.add(operation("scale", size * (even ? glm::dvec3(1) : skew)));
  if (random.chance(0.8)) {
    Element turn = operation("rotate", glm::dvec3(random.direction()));
    turn.attributes.emplace_back("angle", fmt::format("{:.4g}", random.uniform(0, 360)));
    place.add(turn);
  }
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  place.add(operation("translate", choice.reach * glm::dvec3(x, y, z)));
  return shape.add(place);
}

}  // namespace tachylite::test
