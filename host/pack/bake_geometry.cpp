#include "pack/bake_geometry.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "accel/pair_triangles.h"
#include "pack/find_boxes.h"
#include "shared/baked.h"
#include "shared/geometry.h"
#include "shared/light.h"
#include "shared/material.h"

namespace tachylite {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr uint32_t kLongestPath = 512;  // edges; 64 samples of a lane stay below 65535 iterations
constexpr int kMostRough = 2;           // rough types of bsdf: each is evaluated for every vertex
constexpr double kOverlap = 1e-6;       // by which faces are widened: rounding must not open their seams
constexpr double kWallTolerance = 1e-7;  // of boxes: rays leave the walls' triangles, not the box (kGammaWall)
constexpr int kLeastFaces = 4;          // of a box: it costs as much as three of its faces alone

bool paths_are_short(const FeatureSet& f) { return std::min(f.max_depth, f.roulette_depth) <= kLongestPath; }

// The bsdfs of a kernel for whole paths, and the numbers of primitives that it comes for; shaders/CMakeLists.txt.
struct FusedKernel {
  const char* bsdfs;
  std::vector<uint32_t> counts;
};

// The kernel that has the bsdfs of the class; none if none does, or if another structure is faster.
std::optional<FusedKernel> fused_kernel(const MaterialClass& c) {
  constexpr uint32_t kDiffuse = 1u << gpu::kBsdfNull | 1u << gpu::kBsdfDiffuse;
  constexpr uint32_t kSmooth =
      kDiffuse | 1u << gpu::kBsdfConductor | 1u << gpu::kBsdfDielectric | 1u << gpu::kBsdfThinDielectric;
  constexpr uint32_t kRough = 1u << gpu::kBsdfRoughConductor | 1u << gpu::kBsdfRoughDielectric |
                              1u << gpu::kBsdfPlastic | 1u << gpu::kBsdfRoughPlastic;
  constexpr uint32_t kDistributions = gpu::kMaterialBeckmann | gpu::kMaterialGgx;
  if (c.max_leaves > 1 || (c.flags & (gpu::kMaterialTangent | gpu::kMaterialTextured)) != 0) return std::nullopt;
  if ((c.bsdfs & ~kDiffuse) == 0) return FusedKernel{"diffuse", {8, 16, 24, 32, 64}};
  if ((c.bsdfs & ~kSmooth) == 0) return FusedKernel{"smooth", {16, 32, 64}};
  if ((c.bsdfs & ~(kSmooth | kRough)) != 0) return std::nullopt;
  const int rough = std::popcount(c.bsdfs & kRough) * ((c.flags & kDistributions) == kDistributions ? 2 : 1);
  if (rough > kMostRough) return std::nullopt;
  return FusedKernel{"rough", {16, 32}};
}

// A class of `null` alone has no leaf that the others' code could load.
bool leaves_fit(const FeatureSet& f) {
  const auto is_null = [](const MaterialClass& c) { return c.max_leaves == 0; };
  return f.classes.size() == 1 || (!f.classes.empty() && std::none_of(f.classes.begin(), f.classes.end(), is_null));
}

bool fits(const PackedScene& scene) {
  const FeatureSet& f = scene.features;
  const bool flat = !f.vertex_normals && !f.vertex_uv && f.textures == 0 && !f.light_textures && f.aovs == 0;
  return flat && f.media == 0 && !f.hide_emitters && leaves_fit(f) && paths_are_short(f) &&
         scene.bvh.leaves.size() <= gpu::kMaxBaked && !scene.bvh.leaves.empty();
}

// Directions written so far: one that differs only by rounding is written with the same bits, so that the compiler
// shares the dot products with it.
class UnitVectors {
 public:
  explicit UnitVectors(double tolerance) : tolerance_(tolerance) {}

  /// v, or an equal one seen before; negated where its first component that is not zero was negative.
  vec3 canonical(dvec3 v, double& sign) {
    v = glm::normalize(v);
    sign = 1;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(v[axis]) < 1e-9) continue;
      sign = v[axis] < 0 ? -1 : 1;
      break;
    }
    v *= sign;
    for (const vec3& seen : seen_)
      if (glm::length(dvec3(seen) - v) < tolerance_) return seen;
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(v[axis]) < 1e-9) v[axis] = 0;
    seen_.push_back(vec3(v));
    return seen_.back();
  }

 private:
  double tolerance_;
  std::vector<vec3> seen_;
};

class Baker {
 public:
  /// walls: of a scene that has a tree, too.
  Baker(const PackedScene& scene, bool walls)
      : scene_(scene), walls_(walls), rows_(walls ? gpu::kWallRows : gpu::kBakedRows), units_(walls ? 0 : 2e-7) {
    extent_ = glm::max(glm::abs(dvec3(scene.bvh.box_min)), glm::abs(dvec3(scene.bvh.box_max)));
  }

  /// False for what has no place here.
  bool add_leaf(uint32_t leaf) {
    const auto& [r, info] = scene_.bvh.leaves[leaf];
    const uint32_t kind = info.z & gpu::kLeafKindMask;
    if (kind == gpu::kLeafSphere) {
      spheres_.push_back(leaf);
      return true;
    }
    if (kind != gpu::kLeafTriangles) return false;
    std::array<dvec3, 4> v;
    for (int k = 0; k < 4; ++k) v[static_cast<size_t>(k)] = {r[0][k], r[1][k], r[2][k]};
    const auto add = [&](uint32_t face_kind, const dvec3& v0, const dvec3& v1, const dvec3& v2, uint32_t triangle,
                         uint32_t primitive) {
      faces_.push_back({face_kind, {v0, {v1 - v0, v2 - v0}}, 2 * leaf + triangle, primitive});
    };
    const bool parallelogram = info.x != info.y && is_parallelogram(v);
    // A hit on two triangles at once does not tell which: that is enough where both are one light, or none.
    if (parallelogram && (walls_ || lights_do_not_care(info))) {
      add(gpu::kBakedParallelogram, v[0], v[1], v[3], 0, info.x);
    } else {
      add(gpu::kBakedTriangle, v[0], v[1], v[2], 0, info.x);
      if (info.x != info.y) add(gpu::kBakedTriangle, v[0], v[2], v[3], 1, info.y);
    }
    return true;
  }

  /// Empty where there are too many.
  std::optional<BakedGeometry> bake() {
    std::vector<size_t> in_boxes;
    std::vector<Parallelogram> parallelograms;
    for (size_t i = 0; i < faces_.size(); ++i)
      if (faces_[i].kind == gpu::kBakedParallelogram && emits(shape(faces_[i].hit)) == 0) {
        in_boxes.push_back(i);
        parallelograms.push_back(faces_[i].points);
      }
    const double extent = glm::length(extent_);
    const std::vector<Box> boxes = find_boxes(parallelograms, kLeastFaces, (walls_ ? kWallTolerance : kOverlap) * extent);

    std::vector<bool> done(faces_.size(), false);
    for (const Box& box : boxes) {
      std::array<std::optional<size_t>, 6> faces;
      for (size_t f = 0; f < 6; ++f)
        if (box.faces[f]) done[*(faces[f] = in_boxes[*box.faces[f]])] = true;
      put_box(box, faces);
    }
    for (size_t i = 0; i < faces_.size(); ++i)
      if (!done[i]) put_face(faces_[i]);
    for (const uint32_t leaf : spheres_) put_sphere(leaf);
    if (out_.count > gpu::kMaxBaked) return std::nullopt;
    return std::move(out_);
  }

 private:
  struct Face {
    uint32_t kind;
    Parallelogram points;  // of a triangle the half at its corner
    uint32_t hit, primitive;
  };

  bool lights_do_not_care(const glm::uvec4& info) const {
    const uint32_t light = shape_of(info).y;
    if (light == gpu::kNoIndex) return true;
    return (std::bit_cast<uint32_t>(scene_.lights[light].w) & gpu::kLightPairs) != 0;
  }

  void constant(uint32_t index, uint32_t word) {
    out_.constants[gpu::kBakedFirstConstant + gpu::kBakedConstants * out_.count + index] = word;
  }
  void constant(uint32_t index, double value) { constant(index, std::bit_cast<uint32_t>(static_cast<float>(value))); }
  void direction(uint32_t index, const dvec3& unit) {
    for (uint32_t axis = 0; axis < 3; ++axis) constant(index + axis, unit[static_cast<int>(axis)]);
  }
  // Ends a primitive, of which `rows` pairs of rows have been put.
  void finish(uint32_t kind_and_flags, uint32_t rows) {
    const auto end = static_cast<uint32_t>(out_.rows.size() / rows_);
    constant(0, kind_and_flags | (end - rows) << gpu::kBakedRowShift);
    ++out_.count;
  }

  // The constants of direction `d` (from index on): canonical direction and offset, so that points of the plane
  // through `origin` orthogonal to d give 0. Returns the sign that it was given.
  double plane(uint32_t index, const dvec3& d, const dvec3& origin) {
    double sign;
    const dvec3 unit(units_.canonical(d, sign));
    direction(index, unit);
    constant(index + 3, -glm::dot(unit, origin));
    return sign;
  }

  // p = v0 + a e1 + b e2.
  void put_face(const Face& face) {
    const auto& [v0, edges] = face.points;
    const auto& [e1, e2] = edges;
    const dvec3 normal = glm::cross(e1, e2), centre = v0 + 0.5 * (e1 + e2);
    const dvec3 a = glm::cross(e2, normal), b = glm::cross(normal, e1);  // dual to e1 and e2
    plane(1, normal, centre);
    const double sign_a = plane(5, a, centre), sign_b = plane(9, b, centre);
    const auto half = [&](const dvec3& dual, const dvec3& edge, double sign) {
      const dvec3 unit = glm::normalize(dual);
      return sign * (0.5 * glm::dot(unit, edge) * (1 + kOverlap) + 4e-7 * glm::dot(extent_, glm::abs(unit)));
    };
    constant(13, half(a, e1, sign_a));
    constant(14, half(b, e2, sign_b));
    constant(15, face.hit);
    put_face_rows(face);
    finish(face.kind | emits(shape(face.hit)) | (on_hull(face) ? gpu::kBakedHull : 0), 1);
  }

  void put_face_rows(const Face& face) {
    if (walls_) return put_wall_rows(face);
    const auto& [v0, edges] = face.points;
    const dvec3 normal = glm::cross(edges[0], edges[1]), centre = v0 + 0.5 * (edges[0] + edges[1]);
    double sign;
    const dvec3 unit(units_.canonical(normal, sign));
    const bool flip = (shape(face.hit).z & gpu::kShapeFlipNormals) != 0;
    const dvec3 n = unit * (flip ? -sign : sign);
    put_rows(glm::vec4(vec3(n), static_cast<float>(-glm::dot(n, centre))), face.primitive, shape(face.hit),
             face.hit);
  }

  void put_wall_rows(const Face& face) {
    const auto& [v0, edges] = face.points;
    const dvec3 normal = glm::cross(edges[0], edges[1]);
    for (size_t k = 0; k < 2; ++k) {
      const dvec3 across = glm::cross(normal, edges[1 - k]), dual = across / glm::dot(across, edges[k]);
      out_.rows.push_back(glm::vec4(vec3(dual), static_cast<float>(-glm::dot(dual, v0))));
    }
    out_.rows.push_back(glm::vec4(std::bit_cast<float>(face.hit), 0, 0, 0));
  }

  void put_box(const Box& box, const std::array<std::optional<size_t>, 6>& faces) {
    uint32_t present = 0;
    bool hull = true;
    std::array<const Face*, 6> ordered{};
    for (uint32_t k = 0; k < 3; ++k) {
      double sign;
      const dvec3 unit(units_.canonical(box.normals[k], sign));
      direction(1 + 4 * k, unit);
      for (uint32_t side = 0; side < 2; ++side) {
        // Face 2 k has the smaller w.
        const uint32_t from = 2 * k + (sign < 0 ? 1 - side : side), to = 2 * k + side;
        constant(side == 0 ? 4 + 4 * k : 13 + k, glm::dot(unit, box.centres[from]));
        if (!faces[from]) continue;
        ordered[to] = &faces_[*faces[from]];
        present |= 1u << to;
        hull = hull && on_hull(*ordered[to]);
      }
    }
    for (const Face* face : ordered) {
      if (face)
        put_face_rows(*face);
      else
        out_.rows.resize(out_.rows.size() + rows_, glm::vec4(0));
    }
    finish(gpu::kBakedBox | present << gpu::kBakedFaceShift | (hull ? gpu::kBakedHull : 0), 6);
  }

  // Whether everything is on one side of the face's plane, lights too: what goes on between surfaces and lights does
  // not cross it.
  bool on_hull(const Face& face) const {
    for (uint32_t kind = gpu::kLightConstant; kind <= gpu::kLightDirectionalArea; ++kind)
      if (scene_.features.has_light(kind)) return false;  // may lie beyond
    const dvec3 n = glm::normalize(glm::cross(face.points.edges[0], face.points.edges[1]));
    const double tolerance = kOverlap * glm::length(extent_);
    double low = 0, high = 0;
    const auto include = [&](const dvec3& p, double radius) {
      const double distance = glm::dot(n, p - face.points.corner);
      low = std::min(low, distance - radius);
      high = std::max(high, distance + radius);
    };
    for (const Face& other : faces_) {
      const auto& [corner, edges] = other.points;
      for (const dvec3& p : {corner, corner + edges[0], corner + edges[1]}) include(p, 0);
      if (other.kind == gpu::kBakedParallelogram) include(corner + edges[0] + edges[1], 0);
    }
    for (const uint32_t leaf : spheres_) {
      const auto [centre, radius] = sphere(leaf);
      include(dvec3(centre), double{radius});
    }
    if (walls_)  // and the tree
      for (int k = 0; k < 8; ++k) {
        const vec3 &lo = scene_.bvh.box_min, &hi = scene_.bvh.box_max;
        include({k & 1 ? lo.x : hi.x, k & 2 ? lo.y : hi.y, k & 4 ? lo.z : hi.z}, 0);
      }
    return low > -tolerance || high < tolerance;
  }

  std::pair<vec3, float> sphere(uint32_t leaf) const {
    const glm::vec4* rows = &scene_.curved[scene_.bvh.leaves[leaf].info.x];
    float radius = 0;
    for (int axis = 0; axis < 3; ++axis)
      radius = std::max(radius, glm::length(vec3(rows[0][axis], rows[1][axis], rows[2][axis])));
    return {vec3(rows[0].w, rows[1].w, rows[2].w), radius};
  }

  void put_sphere(uint32_t leaf) {
    const auto [centre, radius] = sphere(leaf);
    direction(1, dvec3(centre));
    constant(4, double{radius});
    constant(15, 2 * leaf);
    const glm::uvec4& s = shape(2 * leaf);
    const bool flip = (s.z & gpu::kShapeFlipNormals) != 0;
    put_rows(glm::vec4(centre, flip ? -radius : radius), gpu::kNoIndex, s, 2 * leaf);
    finish(gpu::kBakedSphere | emits(s), 1);
  }

  static uint32_t emits(const glm::uvec4& shape) { return shape.y != gpu::kNoIndex ? gpu::kBakedEmits : 0; }
  const glm::uvec4& shape_of(const glm::uvec4& info) const { return scene_.shapes[info.w >> gpu::kLeafShapeShift]; }
  const glm::uvec4& shape(uint32_t hit) const { return shape_of(scene_.bvh.leaves[hit / 2].info); }

  void put_rows(const glm::vec4& row, uint32_t primitive, const glm::uvec4& s, uint32_t hit) {
    const uint32_t leaf_class =
        scene_.bvh.leaves[hit / 2].info.z >> gpu::kLeafClassShift & gpu::kLeafClassMask;
    const uint32_t material = leaf_class == gpu::kClassNone ? gpu::kNoIndex : s.x;
    out_.rows.push_back(row);
    out_.rows.push_back(glm::vec4(std::bit_cast<float>(material), std::bit_cast<float>(s.y),
                                  std::bit_cast<float>(primitive), std::bit_cast<float>(hit)));
  }

  const PackedScene& scene_;
  const bool walls_;
  const size_t rows_;  // of a face
  dvec3 extent_{0};
  std::vector<Face> faces_;
  std::vector<uint32_t> spheres_;  // leaves
  UnitVectors units_;
  BakedGeometry out_;
};

}  // namespace

std::optional<BakedGeometry> bake_geometry(const PackedScene& scene) {
  if (!fits(scene)) return std::nullopt;
  const std::optional<FusedKernel> kernel = fused_kernel(scene.features.union_class());
  if (!kernel) return std::nullopt;
  Baker baker(scene, false);
  for (uint32_t leaf = 0; leaf < scene.bvh.leaves.size(); ++leaf)
    if (!baker.add_leaf(leaf)) return std::nullopt;
  std::optional<BakedGeometry> baked = baker.bake();
  if (!baked) return std::nullopt;
  for (const uint32_t count : kernel->counts)
    if (count >= baked->count) {
      baked->kernel = fmt::format("follow_paths_{}_{}", count, kernel->bsdfs);
      return baked;
    }
  return std::nullopt;
}

BakedGeometry bake_walls(const PackedScene& scene) {
  Baker baker(scene, true);
  for (uint32_t leaf = scene.bvh.first_wall; leaf < scene.bvh.leaves.size(); ++leaf) baker.add_leaf(leaf);
  return *baker.bake();
}

std::optional<PackedScene> pack_if_baked(const Scene& scene, int sensor) {
  size_t primitives = 0;
  for (const Shape& shape : scene.shapes) {
    const auto* mesh = std::get_if<MeshShape>(&shape.kind);
    primitives += mesh ? mesh->mesh->triangles.size() : 1;
  }
  if (primitives > 2 * gpu::kMaxBaked) return std::nullopt;  // pairs of triangles at best
  std::optional<PackedScene> packed = pack_scene(scene, sensor);
  if (!bake_geometry(*packed)) packed.reset();
  return packed;
}

}  // namespace tachylite
