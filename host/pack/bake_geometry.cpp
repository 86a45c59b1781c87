#include "pack/bake_geometry.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <fmt/format.h>

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
         scene.bvh.leaf_info.size() <= gpu::kMaxBaked && !scene.bvh.leaf_info.empty();
}

// Directions written so far: one that differs only by rounding is written with the same bits, so that the compiler
// shares the dot products with it.
class UnitVectors {
 public:
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
      if (glm::length(dvec3(seen) - v) < 2e-7) return seen;
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(v[axis]) < 1e-9) v[axis] = 0;
    seen_.push_back(vec3(v));
    return seen_.back();
  }

 private:
  std::vector<vec3> seen_;
};

class Baker {
 public:
  explicit Baker(const PackedScene& scene) : scene_(scene) {
    extent_ = glm::max(glm::abs(dvec3(scene.bvh.box_min)), glm::abs(dvec3(scene.bvh.box_max)));
  }

  bool add_leaf(uint32_t leaf) {
    const glm::uvec4& info = scene_.bvh.leaf_info[leaf];
    const uint32_t kind = info.z & gpu::kLeafKindMask;
    if (kind == gpu::kLeafSphere) return add_sphere(leaf, info);
    if (kind != gpu::kLeafTriangles) return false;
    const glm::vec4* r = &scene_.bvh.leaves[size_t{leaf} * gpu::kBvhLeafRows];
    std::array<dvec3, 4> v;
    for (int k = 0; k < 4; ++k) v[static_cast<size_t>(k)] = {r[0][k], r[1][k], r[2][k]};
    if (info.x == info.y) return add_triangle(v[0], v[1], v[2], 2 * leaf, info.x);
    const double size = std::max(glm::length(v[2] - v[0]), glm::length(v[3] - v[1]));
    const bool parallelogram = glm::length(v[0] + v[2] - v[1] - v[3]) < 1e-6 * size;
    // A hit on two triangles at once does not tell which: that is enough where both are one light, or none.
    if (parallelogram && lights_do_not_care(info)) return add_parallelogram(v[0], v[1], v[3], 2 * leaf, info.x);
    return add_triangle(v[0], v[1], v[2], 2 * leaf, info.x) && add_triangle(v[0], v[2], v[3], 2 * leaf + 1, info.y);
  }

  BakedGeometry take() { return std::move(out_); }

 private:
  bool lights_do_not_care(const glm::uvec4& info) const {
    const uint32_t light = scene_.shapes[scene_.triangles[info.x].w].y;
    if (light == gpu::kNoIndex) return true;
    return (std::bit_cast<uint32_t>(scene_.lights[light].w) & gpu::kLightPairs) != 0;
  }

  void constant(uint32_t index, uint32_t word) {
    out_.constants[gpu::kBakedFirstConstant + gpu::kBakedConstants * out_.count + index] = word;
  }
  void constant(uint32_t index, double value) { constant(index, std::bit_cast<uint32_t>(static_cast<float>(value))); }

  // The constants of direction `d` (from index on): canonical direction and offset, so that points of the plane
  // through `origin` orthogonal to d give 0. Returns the sign that it was given.
  double direction(uint32_t index, const dvec3& d, const dvec3& origin) {
    double sign;
    const dvec3 unit(units_.canonical(d, sign));
    for (uint32_t axis = 0; axis < 3; ++axis) constant(index + axis, unit[static_cast<int>(axis)]);
    constant(index + 3, -glm::dot(unit, origin));
    return sign;
  }

  // p = v0 + a e1 + b e2.
  bool add_flat(uint32_t kind, const dvec3& v0, const dvec3& e1, const dvec3& e2, uint32_t hit, uint32_t primitive) {
    if (out_.count >= gpu::kMaxBaked) return false;
    const dvec3 normal = glm::cross(e1, e2), centre = v0 + 0.5 * (e1 + e2);
    const dvec3 a = glm::cross(e2, normal), b = glm::cross(normal, e1);  // dual to e1 and e2
    constant(0, kind | emits(shape(primitive)));
    const double sign_n = direction(1, normal, centre);
    const double sign_a = direction(5, a, centre), sign_b = direction(9, b, centre);
    const auto half = [&](const dvec3& dual, const dvec3& edge, double sign) {
      const dvec3 unit = glm::normalize(dual);
      return sign * (0.5 * glm::dot(unit, edge) * (1 + kOverlap) + 4e-7 * glm::dot(extent_, glm::abs(unit)));
    };
    constant(13, half(a, e1, sign_a));
    constant(14, half(b, e2, sign_b));
    constant(15, hit);

    const bool flip = (shape(primitive).z & gpu::kShapeFlipNormals) != 0;
    double sign;
    const dvec3 n = dvec3(units_.canonical(normal, sign)) * (flip ? -sign_n : sign_n);
    put_rows(glm::vec4(vec3(n), static_cast<float>(-glm::dot(n, centre))), primitive, shape(primitive), hit);
    return true;
  }
  bool add_triangle(const dvec3& v0, const dvec3& v1, const dvec3& v2, uint32_t hit, uint32_t primitive) {
    return add_flat(gpu::kBakedTriangle, v0, v1 - v0, v2 - v0, hit, primitive);
  }
  bool add_parallelogram(const dvec3& v0, const dvec3& v1, const dvec3& v3, uint32_t hit, uint32_t primitive) {
    return add_flat(gpu::kBakedParallelogram, v0, v1 - v0, v3 - v0, hit, primitive);
  }

  bool add_sphere(uint32_t leaf, const glm::uvec4& info) {
    if (out_.count >= gpu::kMaxBaked) return false;
    const glm::vec4* rows = &scene_.curved[info.x];
    const vec3 centre(rows[0].w, rows[1].w, rows[2].w);
    const float radius = rows[3].z;
    for (uint32_t axis = 0; axis < 3; ++axis) constant(1 + axis, double{centre[static_cast<int>(axis)]});
    constant(4, double{radius});
    constant(15, 2 * leaf);
    const glm::uvec4& s = scene_.shapes[std::bit_cast<uint32_t>(rows[3].x)];
    constant(0, gpu::kBakedSphere | emits(s));
    const bool flip = (s.z & gpu::kShapeFlipNormals) != 0;
    put_rows(glm::vec4(centre, flip ? -radius : radius), gpu::kNoIndex, s, 2 * leaf);
    return true;
  }

  static uint32_t emits(const glm::uvec4& shape) { return shape.y != gpu::kNoIndex ? gpu::kBakedEmits : 0; }
  const glm::uvec4& shape(uint32_t triangle) const { return scene_.shapes[scene_.triangles[triangle].w]; }

  void put_rows(const glm::vec4& row, uint32_t primitive, const glm::uvec4& s, uint32_t hit) {
    const uint32_t leaf_class =
        scene_.bvh.leaf_info[hit / 2].z >> gpu::kLeafClassShift & gpu::kLeafClassMask;
    const uint32_t material = leaf_class == gpu::kClassNone ? gpu::kNoIndex : s.x;
    out_.rows.push_back(row);
    out_.rows.push_back(glm::vec4(std::bit_cast<float>(material), std::bit_cast<float>(s.y),
                                  std::bit_cast<float>(primitive), std::bit_cast<float>(hit)));
    ++out_.count;
  }

  const PackedScene& scene_;
  dvec3 extent_{0};
  UnitVectors units_;
  BakedGeometry out_;
};

}  // namespace

std::optional<BakedGeometry> bake_geometry(const PackedScene& scene) {
  if (!fits(scene)) return std::nullopt;
  const std::optional<FusedKernel> kernel = fused_kernel(scene.features.union_class());
  if (!kernel) return std::nullopt;
  Baker baker(scene);
  for (uint32_t leaf = 0; leaf < scene.bvh.leaf_info.size(); ++leaf)
    if (!baker.add_leaf(leaf)) return std::nullopt;
  BakedGeometry baked = baker.take();
  for (const uint32_t count : kernel->counts)
    if (count >= baked.count) {
      baked.kernel = fmt::format("follow_paths_{}_{}", count, kernel->bsdfs);
      return baked;
    }
  return std::nullopt;
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
