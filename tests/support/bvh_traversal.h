#pragma once

// Traversal of a Bvh8 as shared/bvh.h describes it, and the search of all primitives that judges it. Boxes
// are decoded in float; everything else is double, so that a missed hit is the structure's fault.

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "accel/bvh.h"

namespace tachylite::test {

struct Ray {
  glm::dvec3 o, d;
};

/// b1 and b2 are barycentrics of the mesh's own vertex order.
struct TestHit {
  double t = std::numeric_limits<double>::infinity();
  uint32_t primitive = gpu::kNoHit;
  double b1 = 0, b2 = 0;
  bool found() const { return primitive != gpu::kNoHit; }
};

struct DecodedNode {
  uint32_t inner_mask, leaf_mask, kinds, child_base, leaf_base;
  std::array<glm::vec3, 8> lo, hi;
};

inline DecodedNode decode_node(const Bvh8& bvh, uint32_t node) {
  const glm::uvec4* row = &bvh.nodes.at(size_t{node} * gpu::kBvhNodeRows);
  DecodedNode n;
  n.inner_mask = row[0].w >> 24;
  n.child_base = row[1].x;
  n.leaf_base = row[1].y;
  n.leaf_mask = row[1].w & 0xff;
  n.kinds = row[1].w >> 16;
  const uint32_t lo[3][2] = {{row[2].x, row[2].y}, {row[2].z, row[2].w}, {row[3].x, row[3].y}};
  const uint32_t hi[3][2] = {{row[3].z, row[3].w}, {row[4].x, row[4].y}, {row[4].z, row[4].w}};
  for (uint32_t s = 0; s < 8; ++s)
    for (uint32_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<int>(a);
      const float p = std::bit_cast<float>(row[0][axis]);
      const float step = std::bit_cast<float>((row[0].w >> (8 * a) & 0xff) << 23);
      const auto q_lo = static_cast<float>(lo[a][s / 4] >> 8 * (s % 4) & 0xff);
      const auto q_hi = static_cast<float>(hi[a][s / 4] >> 8 * (s % 4) & 0xff);
      n.lo[s][axis] = p + q_lo * step;
      n.hi[s][axis] = p + q_hi * step;
    }
  return n;
}

inline uint32_t leaf_kind(const DecodedNode& n, uint32_t slot) { return n.kinds >> 2 * slot & 3; }

inline uint32_t leaf_of_slot(const DecodedNode& n, uint32_t slot) {
  return n.leaf_base + static_cast<uint32_t>(std::popcount(n.leaf_mask & ((1u << slot) - 1)));
}

inline std::array<glm::vec3, 4> leaf_vertices(const Bvh8& bvh, uint32_t leaf) {
  const auto& r = bvh.leaves.at(leaf).rows;
  const auto vertex = [&](int k) { return glm::vec3(r[0][k], r[1][k], r[2][k]); };
  return {vertex(0), vertex(1), vertex(2), vertex(3)};
}

/// Moeller and Trumbore 1997, from the vertex opposite the longest edge, where rounding matters least; (b0, b1, b2) and
/// t.
inline bool intersect_triangle(const Ray& ray, const glm::dvec3& v0, const glm::dvec3& v1,
                               const glm::dvec3& v2, double& t, glm::dvec3& b) {
  const double l0 = length(v2 - v1), l1 = length(v0 - v2), l2 = length(v1 - v0);
  if (std::max(l1, l2) > l0) {
    glm::dvec3 turned;
    const bool hit = l1 >= l2 ? intersect_triangle(ray, v1, v2, v0, t, turned) : intersect_triangle(ray, v2, v0, v1, t, turned);
    b = l1 >= l2 ? glm::dvec3(turned.z, turned.x, turned.y) : glm::dvec3(turned.y, turned.z, turned.x);
    return hit;
  }
  const glm::dvec3 e1 = v1 - v0, e2 = v2 - v0, p = cross(ray.d, e2), s = ray.o - v0, q = cross(s, e1);
  const double det = dot(e1, p);
  if (det == 0) return false;
  b.y = dot(s, p) / det;
  b.z = dot(ray.d, q) / det;
  b.x = 1 - b.y - b.z;
  t = dot(e2, q) / det;
  return b.x >= 0 && b.y >= 0 && b.z >= 0 && t > 0;
}

/// Distance to the first hit of the unit sphere, disk or cylinder with t > 0, else infinity.
inline double intersect_curved(const Ray& ray, const CurvedPrimitive& c) {
  const glm::dmat4 m = glm::inverse(c.object_to_world);
  const glm::dvec3 o(m * glm::dvec4(ray.o, 1)), d(m * glm::dvec4(ray.d, 0));
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (c.kind == gpu::kLeafDisk) {
    const double t = -o.z / d.z;
    const glm::dvec3 p = o + t * d;
    return t > 0 && p.x * p.x + p.y * p.y <= 1 ? t : kNever;
  }
  const bool sphere = c.kind == gpu::kLeafSphere;
  const glm::dvec3 w(1, 1, sphere ? 1 : 0);
  const double qa = dot(w * d, d), qb = dot(w * o, d), qc = dot(w * o, o) - 1, disc = qb * qb - qa * qc;
  if (!(disc >= 0) || qa == 0) return kNever;
  for (double t : {(-qb - std::sqrt(disc)) / qa, (-qb + std::sqrt(disc)) / qa}) {
    const double z = o.z + t * d.z;
    if (t > 0 && (sphere || (z >= 0 && z <= 1))) return t;
  }
  return kNever;
}

inline TestHit brute_force(const BvhInput& input, const Ray& ray) {
  TestHit best;
  for (size_t i = 0; i < input.triangles.size(); ++i) {
    const glm::uvec3 v = input.triangles[i];
    double t;
    glm::dvec3 b;
    if (intersect_triangle(ray, input.vertices[v.x], input.vertices[v.y], input.vertices[v.z], t, b) &&
        t < best.t)
      best = {t, static_cast<uint32_t>(i), b.y, b.z};
  }
  for (size_t j = 0; j < input.curved.size(); ++j) {
    const double t = intersect_curved(ray, input.curved[j]);
    if (t < best.t) best = {t, static_cast<uint32_t>(input.triangles.size() + j), 0, 0};
  }
  return best;
}

struct TraversalCounts {
  uint64_t rays = 0, nodes = 0, leaves = 0;
  uint32_t stack = 0;  // words
};

/// One word a group of siblings, children in octant order, all hit leaves of a node at once: as the kernel
/// does.
inline TestHit traverse(const BvhInput& input, const Bvh8& bvh, const Ray& ray, TraversalCounts& counts,
                        bool far_first = false) {
  TestHit best;
  ++counts.rays;
  uint32_t octant = far_first ? 0 : 7;  // 7 ^ sign bits
  glm::dvec3 inverse;
  for (int a = 0; a < 3; ++a) {
    if (std::signbit(ray.d[a])) octant ^= 1u << a;
    inverse[a] = 1 / (std::abs(ray.d[a]) < 1e-18 ? std::copysign(1e-18, ray.d[a]) : ray.d[a]);
  }
  struct Group {
    uint32_t child_base, pending;  // bit = slot ^ octant
  };
  std::array<Group, gpu::kBvhMaxDepth + 1> stack;
  uint32_t depth = 0;
  Group group{0, 1u << octant};
  for (;;) {
    if (group.pending == 0) {
      if (depth == 0) return best;
      group = stack[--depth];
      continue;
    }
    const auto bit = static_cast<uint32_t>(std::bit_width(group.pending)) - 1;
    group.pending ^= 1u << bit;
    if (group.pending) {
      stack.at(depth++) = group;
      counts.stack = std::max(counts.stack, depth);
    }
    const DecodedNode n = decode_node(bvh, group.child_base * 8 + (bit ^ octant));
    ++counts.nodes;
    uint32_t hit = 0;
    for (uint32_t s = 0; s < 8; ++s) {
      double near = 0, far = best.t;
      for (int a = 0; a < 3; ++a) {
        const bool negative = std::signbit(ray.d[a]);
        const double t0 = ((negative ? n.hi : n.lo)[s][a] - ray.o[a]) * inverse[a];
        const double t1 = ((negative ? n.lo : n.hi)[s][a] - ray.o[a]) * inverse[a];
        near = std::max(near, t0 - 1e-12 * std::abs(t0));
        far = std::min(far, t1 + 1e-12 * std::abs(t1));
      }
      if (near <= far) hit |= 1u << s;
    }
    group = {n.child_base, 0};
    for (uint32_t s = 0; s < 8; ++s) {
      if (hit & n.inner_mask & 1u << s) group.pending |= 1u << (s ^ octant);
      if (!(hit & n.leaf_mask & 1u << s)) continue;
      ++counts.leaves;
      const uint32_t leaf = leaf_of_slot(n, s);
      const glm::uvec4 info = bvh.leaves.at(leaf).info;
      if (leaf_kind(n, s) != gpu::kLeafTriangles) {
        const double t = intersect_curved(ray, input.curved[info.x - input.triangles.size()]);
        if (t < best.t) best = {t, info.x, 0, 0};
        continue;
      }
      const auto v = leaf_vertices(bvh, leaf);
      for (uint32_t k = 0; k < 2; ++k) {
        double t;
        glm::dvec3 b;
        if (!intersect_triangle(ray, v[0], v[1 + k], v[2 + k], t, b) || t >= best.t) continue;
        const uint32_t r = info.w >> 2 * k & 3;
        best = {t, info[static_cast<int>(k)], b[static_cast<int>((4 - r) % 3)],
                b[static_cast<int>((5 - r) % 3)]};
      }
    }
  }
}

}  // namespace tachylite::test
