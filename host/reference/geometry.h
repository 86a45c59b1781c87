#pragma once

// The shapes of the scene in world space, and rays against them. No scene epsilon: hit points are put onto
// their primitive (from barycentrics, or reprojected), so that they are off by a few roundings of the
// primitive's coordinates, and rays leave from beyond that error, on the side they go to.

#include <memory>
#include <optional>
#include <vector>

#include "reference/bvh2.h"
#include "reference/random.h"
#include "reference/texture/texture.h"
#include "scene/scene.h"

namespace tachylite::reference {

/// A point of a surface and what the material needs of it.
struct SurfacePoint {
  int shape = kNone;
  dvec3 p{0};
  double t = 0;        // along the ray that found it
  double error = 0;    // bound of the distance of p from the surface, in scene units, with a large margin
  dvec3 n_g{0, 0, 1};  // geometric unit normal, with flip_normals; emission and interior/exterior go by it
  TextureCoordinates at;
  dvec3 dp_du{0}, dp_dv{0};
  Frame frame;  // shading frame: n interpolated, s along dp_du, t = n x s

  /// A ray from here along d, offset to the side of d.
  Ray spawn_ray(const dvec3& d) const { return {offset_towards(d), d}; }
  dvec3 offset_towards(const dvec3& d) const { return p + n_g * std::copysign(error, glm::dot(n_g, d)); }
};

/// A point chosen uniformly on a shape: density 1/area w.r.t. area.
struct AreaSample {
  SurfacePoint point;
  double pdf_area = 0;
};

class Geometry {
 public:
  explicit Geometry(const Scene& scene);

  /// The nearest hit with 0 < t < ray.t_max.
  std::optional<SurfacePoint> intersect(const Ray& ray) const { return intersect(ray, false); }
  /// The same, blind to shapes that carry an emitter (hide_emitters).
  std::optional<SurfacePoint> intersect_without_emitters(const Ray& ray) const {
    return intersect(ray, true);
  }
  bool occluded(const Ray& ray) const;

  double area(int shape) const { return shapes_[static_cast<size_t>(shape)].area; }
  AreaSample sample_area(int shape, Random& random) const;

  const Scene& scene() const { return scene_; }

 private:
  /// A shape made ready: a mesh with world-space vertices, or a unit shape with its map.
  struct WorldShape {
    std::shared_ptr<const Mesh> mesh;  // also of a cube; null for the analytic shapes
    std::vector<dvec3> positions;      // world
    std::vector<dvec3> normals;        // world, unit before they are interpolated, as Mitsuba's; empty: faces'
    dmat3 normal_to_world{1};          // inverse transpose of the linear part
    dmat4 to_world{1}, to_object{1};   // analytic: of the unit shape
    double error = 0;
    double area = 0;
    std::vector<double> triangle_area_sums;  // running sum
  };
  struct Primitive {
    int shape;
    uint32_t triangle;  // 0 for analytic shapes
    int apex = 0;       // of a triangle: the vertex opposite its longest edge
  };
  struct Candidate {
    double t;
    dvec3 where;  // barycentrics, or the point in the space of the unit shape
  };

  std::optional<SurfacePoint> intersect(const Ray& ray, bool without_emitters) const;
  struct ShearedRay;
  std::optional<Candidate> intersect_primitive(const Primitive& primitive, const ShearedRay& sheared,
                                               double t_max) const;
  SurfacePoint surface_point(const Primitive& primitive, const dvec3& where) const;
  SurfacePoint triangle_point(const Primitive& primitive, const dvec3& barycentrics) const;
  SurfacePoint analytic_point(const Primitive& primitive, const dvec3& object_point) const;

  const Scene& scene_;
  std::vector<WorldShape> shapes_;
  std::vector<Primitive> primitives_;
  Bvh2 bvh_;
};

}  // namespace tachylite::reference
