#include "scene/load_mesh.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "base/read_file.h"

namespace tachylite {
namespace {

/// Angle between unit vectors; exact for small angles and for angles near pi (Kahan 2006, "How futile are
/// mindless assessments of roundoff", section 12).
double unit_angle(const dvec3& a, const dvec3& b) {
  const double cosine = glm::dot(a, b);
  const double half = std::asin(std::min(0.5 * glm::length(cosine < 0 ? a + b : b - a), 1.0));
  return cosine < 0 ? glm::pi<double>() - 2 * half : 2 * half;
}

dvec3 normalize_or_zero(const dvec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : dvec3(0);
}

}  // namespace

void compute_normals(Mesh& mesh, const std::optional<dmat3>& to_world) {
  const auto is_missing = [&](size_t i) { return mesh.normals[i] == glm::vec3(0); };
  if (mesh.normals.empty()) {
    mesh.normals.assign(mesh.positions.size(), glm::vec3(0));
  } else {
    bool any = false;
    for (size_t i = 0; i < mesh.normals.size(); ++i) any = any || is_missing(i);
    if (!any) return;
  }

  // Sum in double: a vertex may have many triangles of very different size around it. Their normals are found by all
  // threads, and added in the order of the triangles by one.
  struct Corners {
    dvec3 normals[3];
  };
  constexpr size_t kAtOnce = size_t{1} << 16, kGrain = 2048;
  std::vector<Corners> corners(std::min(kAtOnce, mesh.triangles.size()));
  const dmat3 linear = to_world.value_or(dmat3(1));
  std::vector<dvec3> sums(mesh.positions.size(), dvec3(0));
  for (size_t begin = 0; begin < mesh.triangles.size(); begin += kAtOnce) {
    const size_t count = std::min(kAtOnce, mesh.triangles.size() - begin);
    parallel_for(0, count, kGrain, [&](size_t first, size_t last) {
      for (size_t t = first; t < last; ++t) {
        const glm::uvec3& triangle = mesh.triangles[begin + t];
        dvec3 p[3], edge[3];
        for (int i = 0; i < 3; ++i) p[i] = linear * dvec3(mesh.positions[triangle[i]]);
        for (int i = 0; i < 3; ++i) edge[i] = normalize_or_zero(p[(i + 1) % 3] - p[i]);
        const dvec3 normal = normalize_or_zero(glm::cross(p[1] - p[0], p[2] - p[0]));
        for (int i = 0; i < 3; ++i) corners[t].normals[i] = normal * unit_angle(edge[i], -edge[(i + 2) % 3]);
      }
    });
    for (size_t t = 0; t < count; ++t)
      for (int i = 0; i < 3; ++i) sums[mesh.triangles[begin + t][i]] += corners[t].normals[i];
  }
  // Normals go to the world by the inverse transpose; take those found there back.
  const dmat3 back = glm::transpose(linear);
  parallel_for(0, sums.size(), kGrain, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      if (!is_missing(i)) continue;
      const dvec3 normal = normalize_or_zero(back * sums[i]);
      // A vertex with degenerate triangles only, or none, is never shaded; any unit vector will do.
      mesh.normals[i] = normal == dvec3(0) ? glm::vec3(1, 0, 0) : glm::vec3(normal);
    }
  });
}

std::shared_ptr<const Mesh> load_mesh(const MeshRequest& request) {
  const bool obj = request.format == MeshRequest::Format::kObj;
  Mesh mesh = (obj ? read_obj : read_ply)(request.file, request.flip_tex_coords, request.face_normals);
  if (mesh.triangles.empty()) throw InputError(locate_file(request.file), "the mesh holds no faces");
  mesh.path = request.file.string();
  if (!request.face_normals) compute_normals(mesh, request.to_world);
  return std::make_shared<const Mesh>(std::move(mesh));
}

}  // namespace tachylite
