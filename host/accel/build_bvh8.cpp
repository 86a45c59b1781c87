#include <algorithm>
#include <cmath>
#include <limits>

#include "accel/binary_bvh.h"
#include "accel/bvh.h"
#include "accel/choose_walls.h"
#include "accel/flatten_bvh8.h"
#include "accel/pair_triangles.h"
#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/timer.h"

namespace tachylite {
namespace {

constexpr double kMaxAreaRatio = 1.0;  // of a pair's box to the boxes of its triangles

Box box_of(const glm::dvec3& lo, const glm::dvec3& hi) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box b;
  for (int a = 0; a < 3; ++a) {
    float l = static_cast<float>(lo[a]), h = static_cast<float>(hi[a]);
    if (l > lo[a]) l = std::nextafter(l, -kInfinity);
    if (h < hi[a]) h = std::nextafter(h, kInfinity);
    b.lo[a] = l;
    b.hi[a] = h;
  }
  return b;
}

/// Bounds of M's image of the unit sphere, disk or cylinder, rounded outwards: the extent of M(ball) along
/// axis a is the norm of row a of M's linear part, over those columns in which the shape is round.
Box curved_box(const CurvedPrimitive& c) {
  const glm::dmat4& m = c.object_to_world;
  const glm::dvec3 x(m[0]), y(m[1]), z(m[2]), p(m[3]);
  glm::dvec3 r;
  for (int a = 0; a < 3; ++a)
    r[a] = c.kind == gpu::kLeafSphere ? std::sqrt(x[a] * x[a] + y[a] * y[a] + z[a] * z[a])
                                      : std::hypot(x[a], y[a]);
  r *= 1 + 4 * std::numeric_limits<double>::epsilon();
  const glm::dvec3 top = c.kind == gpu::kLeafCylinder ? p + z : p;
  return box_of(glm::min(p, top) - r, glm::max(p, top) + r);
}

void check_curved(const BvhInput& input) {
  for (size_t i = 0; i < input.curved.size(); ++i) {
    const CurvedPrimitive& c = input.curved[i];
    CHECK(c.kind >= gpu::kLeafSphere && c.kind <= gpu::kLeafCylinder);
    const double det = glm::determinant(glm::dmat3(c.object_to_world));
    if (!(std::abs(det) > 0) || !std::isfinite(det))
      throw InputError(fmt::format("curved primitive {}: its transform cannot be inverted", i));
    const Box b = curved_box(c);
    for (int a = 0; a < 3; ++a)
      if (!(b.lo[a] >= -kMaxCoordinate && b.hi[a] <= kMaxCoordinate))
        throw InputError(fmt::format("curved primitive {}: it reaches beyond {}", i, kMaxCoordinate));
  }
}

BulkVector<BinaryNode> bound_primitives(const BvhInput& input, std::span<const TrianglePair> pairs) {
  BulkVector<BinaryNode> primitives(pairs.size() + input.curved.size());
  parallel_for(0, primitives.size(), kMeshGrain, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      Box b;
      if (i < pairs.size())
        for (const glm::vec3& v : pair_vertices(input, pairs[i])) b.grow(Lanes{v.x, v.y, v.z, 0});
      else
        b = curved_box(input.curved[i - pairs.size()]);
      primitives[i].set_box(b);
      primitives[i].first = static_cast<uint32_t>(i);
      primitives[i].is_leaf = 1;
    }
  });
  return primitives;
}

void write_leaves(const BvhInput& input, std::span<const TrianglePair> pairs,
                  std::span<const uint32_t> leaf_primitives, Bvh8& bvh) {
  bvh.leaves.resize(leaf_primitives.size());
  const auto pair_at = [&](size_t i, size_t last) -> const TrianglePair* {
    return i < last && leaf_primitives[i] < pairs.size() ? &pairs[leaf_primitives[i]] : nullptr;
  };
  parallel_for(0, leaf_primitives.size(), kMeshGrain, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      // Leaves are in the order of the tree, which the mesh need not have: ask for its parts ahead of time.
      constexpr size_t kAhead = 16;
      if (const TrianglePair* p = pair_at(i + 3 * kAhead, last)) __builtin_prefetch(p);
      if (const TrianglePair* p = pair_at(i + 2 * kAhead, last)) __builtin_prefetch(&input.triangles[p->first]);
      if (const TrianglePair* p = pair_at(i + kAhead, last))
        for (int k = 0; k < 3; ++k) __builtin_prefetch(&input.vertices[input.triangles[p->first][k]]);

      BvhLeaf& leaf = bvh.leaves[i];
      const uint32_t primitive = leaf_primitives[i];
      if (primitive < pairs.size()) {
        const TrianglePair& pair = pairs[primitive];
        const std::array<glm::vec3, 4> v = pair_vertices(input, pair);
        for (int a = 0; a < 3; ++a) leaf.rows[a] = {v[0][a], v[1][a], v[2][a], v[3][a]};
        const bool lone = pair.second == TrianglePair::kNoTriangle;
        leaf.info = {pair.first, lone ? pair.first : pair.second, gpu::kLeafTriangles,
                     lone ? pair.rotation * 5 : pair.rotation};
      } else {
        const size_t c = primitive - pairs.size();
        const glm::dmat4 inverse = glm::inverse(input.curved[c].object_to_world);
        for (int r = 0; r < 3; ++r)
          leaf.rows[r] = glm::vec4(inverse[0][r], inverse[1][r], inverse[2][r], inverse[3][r]);
        const auto number = static_cast<uint32_t>(input.triangles.size() + c);
        leaf.info = {number, number, input.curved[c].kind, 0};
      }
    }
  });
}

}  // namespace

Bvh8 build_bvh8(const BvhInput& input, const BvhSettings& settings) {
  CHECK_LT(input.triangles.size() + input.curved.size(), size_t{1} << 31);
  Bvh8 bvh;
  BvhStatistics& stats = bvh.statistics;

  Timer timer;
  check_curved(input);
  const Pairing pairing = pair_triangles(input, kMaxAreaRatio);
  const size_t leaves = pairing.pairs.size() + input.curved.size();
  const CurvedLeaves curved{static_cast<uint32_t>(pairing.pairs.size()), input.curved};
  stats.pair_seconds = timer.seconds();

  timer = Timer();
  constexpr int kMaxBinaryDepth = 96;
  BulkVector<BinaryNode> primitives = bound_primitives(input, pairing.pairs);
  const std::vector<uint32_t> walls = choose_walls(input, pairing.pairs, primitives, settings.most_walls);
  Box box;
  for (const uint32_t wall : walls) box.grow(primitives[wall].box());
  const auto build_without_walls = [&](BulkVector<BinaryNode> all, int max_depth) {
    const auto is_wall = [&](const BinaryNode& n) { return std::find(walls.begin(), walls.end(), n.first) != walls.end(); };
    if (!walls.empty()) std::erase_if(all, is_wall);
    return build_binary_bvh(std::move(all), settings.bins, max_depth);
  };
  BinaryBvh binary = build_without_walls(std::move(primitives), kMaxBinaryDepth);
  stats.build_seconds = timer.seconds();
  timer = Timer();
  optimise_binary_bvh(binary, settings.reinsertion_passes);
  stats.optimise_seconds = timer.seconds();
  const ExpectedVisits visits = expected_visits(binary);

  timer = Timer();
  FlatNodes flat = flatten_bvh8(binary, curved);
  if (flat.depth > static_cast<int>(gpu::kBvhMaxDepth)) {
    // A wide tree is never deeper than the binary one.
    binary = build_without_walls(bound_primitives(input, pairing.pairs), gpu::kBvhMaxDepth);
    flat = flatten_bvh8(binary, curved);
  }
  CHECK_LE(flat.depth, static_cast<int>(gpu::kBvhMaxDepth));
  bvh.nodes = std::move(flat.rows);
  bvh.first_wall = static_cast<uint32_t>(flat.leaf_primitives.size());
  flat.leaf_primitives.insert(flat.leaf_primitives.end(), walls.begin(), walls.end());
  write_leaves(input, pairing.pairs, flat.leaf_primitives, bvh);
  stats.flatten_seconds = timer.seconds();

  if (leaves) {
    if (!binary.nodes.empty()) box.grow(binary.nodes[BinaryBvh::kRoot].box());
    bvh.box_min = {box.lo[0], box.lo[1], box.lo[2]};
    bvh.box_max = {box.hi[0], box.hi[1], box.hi[2]};
  }
  stats.triangles = input.triangles.size();
  stats.dropped = pairing.dropped;
  stats.leaves = leaves;
  stats.pairs = input.triangles.size() - pairing.dropped - pairing.pairs.size();
  stats.curved = input.curved.size();
  stats.walls = walls.size();
  stats.nodes2 = bvh.first_wall ? bvh.first_wall - 1 : 0;
  stats.nodes8 = flat.nodes;
  stats.sah_cost2 = settings.traversal_cost * visits.inner + settings.intersection_cost * visits.leaves;
  stats.sah_cost8 =
      settings.traversal_cost * flat.node_visits + settings.intersection_cost * flat.leaf_visits;
  stats.node_visits8 = flat.node_visits;
  stats.leaf_visits8 = flat.leaf_visits;
  stats.depth8 = flat.depth;
  stats.children_per_node = static_cast<double>(flat.children) / static_cast<double>(flat.nodes);
  stats.node_bytes = bvh.nodes.size() * sizeof bvh.nodes[0];
  stats.leaf_bytes = bvh.leaves.size() * sizeof bvh.leaves[0];
  return bvh;
}

}  // namespace tachylite
