#include "accel/choose_walls.h"

#include <algorithm>

#include "base/parallel.h"

namespace tachylite {
namespace {

constexpr double kLeastShare = 1.0 / 32;

Box bound_all(std::span<const BinaryNode> primitives, const std::vector<uint32_t>& without) {
  std::vector<Box> parts((primitives.size() + kMeshGrain - 1) / kMeshGrain);
  parallel_for_each(parts.size(), [&](size_t part) {
    const size_t first = part * kMeshGrain, last = std::min(first + kMeshGrain, primitives.size());
    for (size_t i = first; i < last; ++i)
      if (std::find(without.begin(), without.end(), i) == without.end()) parts[part].grow(primitives[i].box());
  });
  Box all;
  for (const Box& part : parts) all.grow(part);
  return all;
}

// Area of a pair that is a parallelogram; 0 of others.
double parallelogram_area(const BvhInput& input, const TrianglePair& pair) {
  if (pair.second == TrianglePair::kNoTriangle) return 0;
  std::array<glm::dvec3, 4> v;
  std::ranges::copy(pair_vertices(input, pair), v.begin());
  return is_parallelogram(v) ? glm::length(glm::cross(v[1] - v[0], v[3] - v[0])) : 0;
}

struct Candidate {
  uint32_t pair;
  double area;
};

// Parallelograms of at least that area, the largest first.
std::vector<Candidate> candidates(const BvhInput& input, std::span<const TrianglePair> pairs,
                                  std::span<const BinaryNode> primitives, double least) {
  std::vector<std::vector<Candidate>> parts((pairs.size() + kMeshGrain - 1) / kMeshGrain);
  parallel_for_each(parts.size(), [&](size_t part) {
    const size_t first = part * kMeshGrain, last = std::min(first + kMeshGrain, pairs.size());
    for (size_t i = first; i < last; ++i) {
      if (half_area(primitives[i].box()) < least) continue;  // no less than the area of what is flat
      const double area = parallelogram_area(input, pairs[i]);
      if (area >= least) parts[part].push_back({static_cast<uint32_t>(i), area});
    }
  });
  std::vector<Candidate> all;
  for (const std::vector<Candidate>& part : parts) all.insert(all.end(), part.begin(), part.end());
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.area > b.area; });
  return all;
}

}  // namespace

std::vector<uint32_t> choose_walls(const BvhInput& input, std::span<const TrianglePair> pairs,
                                   std::span<const BinaryNode> primitives, uint32_t most) {
  std::vector<uint32_t> walls;
  while (walls.size() < most) {
    const size_t before = walls.size();
    if (before == primitives.size()) break;
    const double least = kLeastShare * static_cast<double>(half_area(bound_all(primitives, walls)));
    if (!(least > 0)) break;
    for (const Candidate& c : candidates(input, pairs, primitives, least))
      if (walls.size() < most && std::find(walls.begin(), walls.end(), c.pair) == walls.end()) walls.push_back(c.pair);
    if (walls.size() == before) break;
  }
  return walls;
}

}  // namespace tachylite
