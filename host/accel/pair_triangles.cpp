#include "accel/pair_triangles.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

#include "accel/box.h"
#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"

namespace tachylite {
namespace {

constexpr uint32_t kNone = 0xffffffffu, kDropped = kNone - 1;

Lanes lanes(const glm::vec3& v) {
  return Lanes{v.x, v.y, v.z, 0};
}

Box triangle_box(const BvhInput& input, uint32_t t) {
  const glm::uvec3 v = input.triangles[t];
  Box b;
  for (int k = 0; k < 3; ++k) b.grow(lanes(input.vertices[v[k]]));
  return b;
}

bool has_area(const BvhInput& input, uint32_t t) {
  const glm::uvec3 v = input.triangles[t];
  const glm::dvec3 a(input.vertices[v.x]), b(input.vertices[v.y]), c(input.vertices[v.z]);
  const glm::dvec3 n = glm::cross(b - a, c - a);
  return n.x != 0 || n.y != 0 || n.z != 0;
}

void check_vertices(const BvhInput& input) {
  parallel_for(0, input.triangles.size(), kMeshGrain, [&](size_t first, size_t last) {
    for (size_t t = first; t < last; ++t)
      for (int k = 0; k < 3; ++k) {
        CHECK_LT(input.triangles[t][k], input.vertices.size());
        const glm::vec3 p = input.vertices[input.triangles[t][k]];
        for (int a = 0; a < 3; ++a)
          if (!(std::abs(p[a]) <= kMaxCoordinate))
            throw InputError(fmt::format("triangle {}: coordinate {} is not finite or too large (at most {})",
                                         t, p[a], kMaxCoordinate));
      }
  });
}

/// For each vertex the lowest-numbered vertex of the same bits. Open addressing; which thread comes first
/// changes the table but not the answer.
BulkVector<uint32_t> find_representatives(std::span<const glm::vec3> vertices) {
  const size_t n = vertices.size();
  const size_t mask = std::bit_ceil(std::max<size_t>(2 * n, 16)) - 1;
  BulkVector<uint32_t> table(mask + 1), slots(n);
  parallel_fill<uint32_t>(table, kNone);
  const auto slot_of = [&](const glm::vec3& p) {
    uint32_t bits[3];
    std::memcpy(bits, &p, sizeof bits);
    uint64_t h = 0;
    for (uint32_t b : bits) h = (h ^ b) * 0x9e3779b97f4a7c15ull, h ^= h >> 32;
    return h & mask;
  };
  const auto equal = [&](uint32_t a, uint32_t b) {
    return !std::memcmp(&vertices[a], &vertices[b], sizeof(glm::vec3));
  };

  parallel_for(0, n, kMeshGrain, [&](size_t first, size_t last) {
    constexpr size_t kAhead = 16;  // the table is too large for the cache
    size_t hashed = first;
    for (size_t i = first; i < last; ++i) {
      for (; hashed < std::min(i + kAhead, last); ++hashed) {
        slots[hashed] = static_cast<uint32_t>(slot_of(vertices[hashed]));
        __builtin_prefetch(&table[slots[hashed]]);
      }
      const auto v = static_cast<uint32_t>(i);
      for (size_t s = slots[i];; s = (s + 1) & mask) {
        slots[i] = static_cast<uint32_t>(s);
        std::atomic_ref<uint32_t> slot(table[s]);
        uint32_t held = slot.load(std::memory_order_relaxed);
        if (held == kNone && slot.compare_exchange_strong(held, v, std::memory_order_relaxed)) break;
        if (!equal(held, v)) continue;
        while (v < held && !slot.compare_exchange_weak(held, v, std::memory_order_relaxed)) {
        }
        break;
      }
    }
  });
  parallel_for(0, n, kMeshGrain, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) slots[i] = table[slots[i]];
  });
  return slots;
}

/// Half edge 3t + e goes from vertex e to vertex e + 1 of triangle t. Its partner is the half edge that runs
/// the other way; where more than two triangles meet in an edge, partners are taken in the order of the
/// triangles.
class Matcher {
 public:
  Matcher(const BvhInput& input, double max_area_ratio)
      : input_(input),
        max_area_ratio_(static_cast<float>(max_area_ratio)),
        partner_(3 * input.triangles.size()),
        gain_(3 * input.triangles.size()),
        mate_(input.triangles.size()) {
    parallel_fill<uint32_t>(partner_, kNone);
    parallel_fill<uint32_t>(mate_, kNone);
  }

  Pairing run() {
    find_partners(find_representatives(input_.vertices));
    match();
    return collect();
  }

 private:
  static uint32_t edge_end(uint32_t e) { return e == 2 ? 0 : e + 1; }

  void find_partners(std::span<const uint32_t> vertex) {
    // List the half edges of each lower vertex; partner_ is the next of the list, for now.
    BulkVector<uint32_t> lists(vertex.size());
    parallel_fill<uint32_t>(lists, kNone);
    BulkVector<uint64_t> edges(partner_.size());  // upper vertex << 32 | half edge << 1 | runs downwards
    parallel_for(0, input_.triangles.size(), kMeshGrain, [&](size_t first, size_t last) {
      for (size_t t = first; t < last; ++t) {
        if (!has_area(input_, static_cast<uint32_t>(t))) {
          mate_[t] = kDropped;
          continue;
        }
        const glm::uvec3 v = input_.triangles[t];
        for (uint32_t e = 0; e < 3; ++e) {
          const auto h = static_cast<uint32_t>(3 * t + e);
          const uint32_t from = vertex[v[e]], to = vertex[v[edge_end(e)]];
          edges[h] = static_cast<uint64_t>(std::max(from, to)) << 32 | static_cast<uint64_t>(h) << 1 | (from > to);
          partner_[h] = std::atomic_ref<uint32_t>(lists[std::min(from, to)]).exchange(h, std::memory_order_relaxed);
        }
      }
    });
    parallel_for(0, lists.size(), kMeshGrain, [&](size_t first, size_t last) {
      std::vector<uint64_t> listed;
      for (size_t v = first; v < last; ++v) {
        listed.clear();
        for (uint32_t h = lists[v]; h != kNone; h = std::exchange(partner_[h], kNone)) listed.push_back(edges[h]);
        std::sort(listed.begin(), listed.end());  // makes their order independent of the threads
        const auto end = listed.end();
        for (auto run = listed.begin(); run != end;) {
          auto run_end = run;
          while (run_end != end && *run_end >> 32 == *run >> 32) ++run_end;
          auto up = run, down = run;
          for (;; ++up, ++down) {
            while (up != run_end && *up & 1) ++up;
            while (down != run_end && !(*down & 1)) ++down;
            if (up == run_end || down == run_end) break;
            consider(static_cast<uint32_t>(*up) >> 1, static_cast<uint32_t>(*down) >> 1);
          }
          run = run_end;
        }
      }
    });
  }

  void consider(uint32_t a, uint32_t b) {
    const uint32_t s = a / 3, t = b / 3;
    if (s == t || (!input_.groups.empty() && input_.groups[s] != input_.groups[t])) return;
    const Box box_s = triangle_box(input_, s), box_t = triangle_box(input_, t);
    const float apart = half_area(box_s) + half_area(box_t), together = half_area(merge(box_s, box_t));
    if (together > max_area_ratio_ * apart) return;
    partner_[a] = b;
    partner_[b] = a;
    gain_[a] = gain_[b] = max_area_ratio_ * apart - together;
  }

  /// The half edge of t with the greatest gain towards an unmatched triangle; ties go to the lower edge
  /// number, so that edges are totally ordered.
  uint32_t best_half_edge(uint32_t t) const {
    uint32_t best = kNone, best_name = kNone;
    for (uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      const uint32_t p = partner_[h];
      if (p == kNone || mate_[p / 3] != kNone) continue;
      const uint32_t name = std::min(h, p);
      if (best == kNone || gain_[h] > gain_[best] || (gain_[h] == gain_[best] && name < best_name)) {
        best = h;
        best_name = name;
      }
    }
    return best;
  }

  /// Rounds of matching all edges that are the best of both their triangles (the matching of the globally
  /// greedy order); a long chain of ever better edges would take as many rounds, so the rest goes one by one.
  void match() {
    BulkVector<uint32_t> open(mate_.size()), still_open(mate_.size()), best(mate_.size());
    parallel_for(0, open.size(), kMeshGrain, [&](size_t first, size_t last) {
      for (size_t t = first; t < last; ++t) open[t] = static_cast<uint32_t>(t);
    });
    for (int round = 0; round < 12 && !open.empty(); ++round) {
      parallel_for(0, open.size(), kMeshGrain, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) best[open[i]] = best_half_edge(open[i]);
      });
      parallel_for(0, open.size(), kMeshGrain, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) {
          const uint32_t h = best[open[i]];
          if (h != kNone && best[partner_[h] / 3] == partner_[h]) mate_[open[i]] = h;
        }
      });
      const auto is_open = [&](uint32_t t) { return best[t] != kNone && mate_[t] == kNone; };
      const auto range = [&](size_t first, size_t last) { return std::span(open).subspan(first, last - first); };
      still_open.resize(parallel_scan(
          open.size(),
          [&](size_t first, size_t last) {
            return static_cast<size_t>(std::ranges::count_if(range(first, last), is_open));
          },
          [&](size_t first, size_t last, size_t at) {
            std::ranges::copy_if(range(first, last), still_open.data() + at, is_open);
          }));
      open.swap(still_open);
    }
    for (uint32_t t : open) {
      if (mate_[t] != kNone) continue;
      const uint32_t h = best_half_edge(t);
      if (h == kNone) continue;
      mate_[t] = h;
      mate_[partner_[h] / 3] = partner_[h];
    }
  }

  uint32_t longest_edge(uint32_t t) const {
    const glm::uvec3 v = input_.triangles[t];
    uint32_t longest = 2;  // of several that of the mesh's own order
    double most = 0;
    for (const uint32_t e : {2u, 0u, 1u}) {
      const glm::dvec3 edge = glm::dvec3(input_.vertices[v[edge_end(e)]]) - glm::dvec3(input_.vertices[v[e]]);
      if (const double length2 = glm::dot(edge, edge); length2 > most) longest = e, most = length2;
    }
    return longest;
  }

  Pairing collect() const {
    const size_t triangles = input_.triangles.size();
    const auto is_first = [&](uint32_t t) {
      const uint32_t h = mate_[t];
      return h == kNone || (h != kDropped && partner_[h] / 3 > t);
    };
    Pairing result;
    result.pairs.resize(triangles);
    result.pairs.resize(parallel_scan(
        triangles,
        [&](size_t first, size_t last) {
          size_t count = 0;
          for (size_t t = first; t < last; ++t) count += is_first(static_cast<uint32_t>(t));
          return count;
        },
        [&](size_t first, size_t last, size_t at) {
          for (size_t i = first; i < last; ++i) {
            const auto t = static_cast<uint32_t>(i);
            if (!is_first(t)) continue;
            const uint32_t h = mate_[t];
            if (h == kNone) {
              result.pairs[at++] = {t, TrianglePair::kNoTriangle, edge_end(longest_edge(t))};
              continue;
            }
            const uint32_t p = partner_[h];
            // The shared edge closes the first triangle (v2 -> v0) and opens the second (v0 -> v2).
            result.pairs[at++] = {t, p / 3, edge_end(h % 3) | (p % 3) << 2};
          }
        }));
    const size_t kept = parallel_reduce<size_t>(
        0, result.pairs.size(),
        [&](size_t first, size_t last) {
          size_t count = 0;
          for (size_t i = first; i < last; ++i) count += result.pairs[i].second == TrianglePair::kNoTriangle ? 1 : 2;
          return count;
        },
        std::plus());
    result.dropped = triangles - kept;
    return result;
  }

  const BvhInput& input_;
  const float max_area_ratio_;
  BulkVector<uint32_t> partner_;  // of each half edge
  BulkVector<float> gain_;        // of each half edge with a partner [area]
  BulkVector<uint32_t> mate_;     // of each triangle: its half edge to the triangle it is paired with; or kDropped
};

}  // namespace

Pairing pair_triangles(const BvhInput& input, double max_area_ratio) {
  CHECK_LT(input.triangles.size(), size_t{0xffffffffu} / 6);
  CHECK(input.groups.empty() || input.groups.size() == input.triangles.size());
  check_vertices(input);
  return Matcher(input, max_area_ratio).run();
}

std::array<glm::vec3, 4> pair_vertices(const BvhInput& input, const TrianglePair& pair) {
  const glm::uvec3 a = input.triangles[pair.first];
  const uint32_t r0 = pair.rotation & 3, r1 = pair.rotation >> 2;
  const auto vertex = [&](const glm::uvec3& t, uint32_t k) {
    return input.vertices[t[static_cast<int>(k % 3)]];
  };
  const glm::vec3 v2 = vertex(a, 2 + r0);
  return {vertex(a, r0), vertex(a, 1 + r0), v2,
          pair.second == TrianglePair::kNoTriangle ? v2 : vertex(input.triangles[pair.second], 2 + r1)};
}

bool is_parallelogram(const std::array<glm::dvec3, 4>& corners) {
  const auto& [a, b, c, d] = corners;
  const double size = std::max(glm::length(c - a), glm::length(d - b));
  return glm::length(a + c - b - d) < 1e-6 * size;
}

}  // namespace tachylite
