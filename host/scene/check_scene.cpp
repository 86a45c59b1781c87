#include "scene/check_scene.h"

#include <algorithm>

#include "base/error.h"
#include "base/log.h"

namespace tachylite {
namespace {

/// Points whose hull holds the shape, in its own space; meshes aside.
std::vector<dvec3> hull(const Shape& shape) {
  dvec3 low(-1), high(1);
  if (std::holds_alternative<RectangleShape>(shape.kind) || std::holds_alternative<DiskShape>(shape.kind)) {
    low.z = high.z = 0;
  } else if (const auto* sphere = std::get_if<SphereShape>(&shape.kind)) {
    low = sphere->center - sphere->radius;
    high = sphere->center + sphere->radius;
  } else if (const auto* cylinder = std::get_if<CylinderShape>(&shape.kind)) {
    low = glm::min(cylinder->p0, cylinder->p1) - cylinder->radius;
    high = glm::max(cylinder->p0, cylinder->p1) + cylinder->radius;
  }
  std::vector<dvec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
  return corners;
}

double farthest(const dmat4& to_world, const dvec3& point) {
  const dvec3 p = glm::abs(dvec3(to_world * glm::dvec4(point, 1)));
  return std::max({p.x, p.y, p.z});
}

void check_extent(const Shape& shape) {
  double reach = 0;
  if (const auto* mesh = std::get_if<MeshShape>(&shape.kind)) {
    for (const glm::vec3& p : mesh->mesh->positions) reach = std::max(reach, farthest(shape.to_world, p));
  } else {
    for (const dvec3& p : hull(shape)) reach = std::max(reach, farthest(shape.to_world, p));
  }
  if (!(reach <= kMaxCoordinate))
    throw InputError(shape.where,
                     fmt::format("{} reaches to {:.3g}, which is too far: at most {:.0e} is possible",
                                 shape.plugin, reach, kMaxCoordinate));
}

/// Whether some triangle has an area in world space.
bool has_area(const Shape& shape) {
  const auto* mesh = std::get_if<MeshShape>(&shape.kind);
  if (!mesh) return true;
  const dmat3 linear(shape.to_world);
  const auto& positions = mesh->mesh->positions;
  return std::any_of(mesh->mesh->triangles.begin(), mesh->mesh->triangles.end(), [&](const glm::uvec3& t) {
    const dvec3 p0 = positions[t.x];
    return glm::cross(linear * (dvec3(positions[t.y]) - p0), linear * (dvec3(positions[t.z]) - p0)) !=
           dvec3(0);
  });
}

}  // namespace

void check_scene(const Scene& scene) {
  for (const Shape& shape : scene.shapes) {
    check_extent(shape);
    if (has_area(shape)) continue;
    if (shape.emitter != kNone)
      throw InputError(shape.where,
                       fmt::format("{} emits, but all its triangles are degenerate", shape.plugin));
    log_warning(fmt::format("{}: all triangles of {} are degenerate", shape.where.str(), shape.plugin));
  }
}

}  // namespace tachylite
