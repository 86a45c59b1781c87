#include "wavefront/photon_guide.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "base/parallel.h"
#include "pack/find_focusers.h"
#include "pack/float_bits.h"
#include "shared/guide.h"
#include "shared/material.h"

namespace tachylite {
namespace {

using gpu::kGuideCellBins;

// Of directions that follow the photons where there are many. The rest follow the cosine, so that no weight exceeds
// 1 / (1 - kGuidedShare) times that of an unguided sample by more than rounding of probabilities.
constexpr double kGuidedShare = 0.85;
// Mean photons in a cell that count as much as the uniform distribution.
constexpr double kUniformPhotons = 16;
// The same of a focuser's table.
constexpr double kFocusedShare = 0.95, kUniformOfFocuser = 4;
// Photons are spread over the bins around their own: weights by distance along a side; of two sides their product. What
// reaches a cell from elsewhere than focusers changes slowly with direction.
constexpr std::array<double, 3> kSharp = {1, 0.2, 0}, kSmooth = {1, 0.6, 0.1};
constexpr double kCellsAcross = 8;  // the film, at least
constexpr int kBins = gpu::kGuideBins;
static_assert(kBins == 1 << gpu::kGuideLevels && (kGuideCellBins - 1) / 3 <= gpu::kGuideDensities);

using Densities = std::array<double, kGuideCellBins>;  // mean 1

// Of each bin its mean with its neighbours; sides and corners of the square have fewer.
Densities spread(std::span<const uint32_t> bins, const std::array<double, 3>& weights) {
  constexpr int kReach = 2;
  Densities mean{};
  for (int y = 0; y < kBins; ++y)
    for (int x = 0; x < kBins; ++x) {
      double sum = 0, all = 0;
      for (int v = std::max(y - kReach, 0); v <= std::min(y + kReach, kBins - 1); ++v)
        for (int u = std::max(x - kReach, 0); u <= std::min(x + kReach, kBins - 1); ++u) {
          const double weight =
              weights[static_cast<size_t>(std::abs(u - x))] * weights[static_cast<size_t>(std::abs(v - y))];
          sum += weight * bins[static_cast<size_t>(v * kBins + u)];
          all += weight;
        }
      mean[static_cast<size_t>(y * kBins + x)] = sum / all;
    }
  return mean;
}

double sum_of(const Densities& density, uint32_t x, uint32_t y, uint32_t edge) {
  double sum = 0;
  for (uint32_t v = y; v < y + edge; ++v)
    for (uint32_t u = x; u < x + edge; ++u) sum += density[v * kBins + u];
  return sum;
}

// In 2^-16, neither 0 nor 1.
uint32_t probability(double part, double whole) {
  return static_cast<uint32_t>(std::clamp(std::round(0x1p16 * part / whole), 1.0, 0x1p16 - 1));
}

// Writes a node of the quadtree over the bins, all below it, and the density that they make of it; here: its own.
void build_tree(const Densities& density, uint32_t x, uint32_t y, uint32_t edge, uint32_t node, double here,
                std::span<glm::uvec2> out) {
  if (edge == 1) {
    const uint32_t bin = y * kBins + x;
    out[gpu::kGuideDensities + bin / 2][static_cast<int>(bin % 2)] = bits(here);
    return;
  }
  const uint32_t half = edge / 2;
  double quadrant[2][2];  // [x][y]
  for (uint32_t i = 0; i < 2; ++i)
    for (uint32_t j = 0; j < 2; ++j) quadrant[i][j] = sum_of(density, x + i * half, y + j * half, half);
  const double left = quadrant[0][0] + quadrant[0][1], right = quadrant[1][0] + quadrant[1][1];
  const uint32_t p = probability(left, left + right);
  const uint32_t q[2] = {probability(quadrant[0][0], left), probability(quadrant[1][0], right)};
  out[node] = {p, q[0] | q[1] << 16};
  for (uint32_t i = 0; i < 2; ++i)
    for (uint32_t j = 0; j < 2; ++j)
      build_tree(density, x + i * half, y + j * half, half, 4 * node + 1 + i + 2 * j,
                 here * 4 * 0x1p-32 * (i == 0 ? p : 0x10000 - p) * (j == 0 ? q[i] : 0x10000 - q[i]), out);
}

double photons_in(std::span<const uint32_t> bins) {
  uint64_t flux = 0;
  for (const uint32_t f : bins) flux += f;
  return static_cast<double>(flux) / gpu::kPhotonUnit;
}

// A table whose samples follow the photons by `share` and are uniform else.
void build_table(std::span<const uint32_t> bins, double share, const std::array<double, 3>& weights,
                 std::span<glm::uvec2> out) {
  Densities density;
  density.fill(1);
  if (share > 0) {
    density = spread(bins, weights);
    const double sum = sum_of(density, 0, 0, kBins);
    for (double& d : density) d = 1 - share + share * kGuideCellBins * d / sum;
  }
  build_tree(density, 0, 0, kBins, 0, 1, out);
}

// All tables of a cell. Each has the share of the samples that its light has of all light, but for the share that is
// uniform, which is the first table's.
void build_cell(std::span<const uint32_t> flux, std::span<glm::uvec2> out) {
  const size_t tables = flux.size() / kGuideCellBins;
  const auto table_of = [](auto cell, size_t table) { return cell.subspan(table * kGuideCellBins, kGuideCellBins); };
  std::array<double, 1 + gpu::kMaxFocusers> photons{};
  double all = 0;
  for (size_t t = 0; t < tables; ++t) all += photons[t] = photons_in(table_of(flux, t));
  const double guided = kGuidedShare * all / (all + kUniformPhotons);
  glm::vec4 shares(0, 0, 0, 1 - guided);
  for (size_t t = 1; t < tables; ++t) {
    if (photons[t] == 0) continue;  // no samples
    shares[static_cast<int>(t) - 1] = static_cast<float>(guided * photons[t] / all);
    build_table(table_of(flux, t), kFocusedShare * photons[t] / (photons[t] + kUniformOfFocuser), kSharp,
                table_of(out, t));
  }
  if (all > 0) {
    const double rest = guided * photons[0] / all;
    build_table(table_of(flux, 0), rest / (1 - guided + rest), tables > 1 ? kSmooth : kSharp, table_of(out, 0));
  }
  out[gpu::kGuideShares] = {glm::packUnorm2x16({shares.x, shares.y}), glm::packUnorm2x16({shares.z, shares.w})};
}

}  // namespace

bool can_be_guided(const MaterialClass& c) {
  return c.bsdfs == 1u << gpu::kBsdfDiffuse && c.max_leaves == 1 && (c.flags & gpu::kMaterialNestedFrames) == 0;
}

bool may_be_guided(const PackedScene& scene, Guiding guiding) {
  const FeatureSet& f = scene.features;
  constexpr uint32_t kAreaLights = (2u << gpu::kLightCylinder) - 1, kKinds = (2u << gpu::kLightDirectionalArea) - 1;
  if (guiding == Guiding::kOff || scene.emission.empty() || (f.lights & kKinds & ~kAreaLights) != 0) return false;
  if (f.media != 0 || f.max_depth <= 2 || f.strategy != gpu::kStrategyMis) return false;
  return std::any_of(f.classes.begin(), f.classes.end(), can_be_guided) &&
         (guiding == Guiding::kOn || std::any_of(f.classes.begin(), f.classes.end(), can_focus));
}

uint32_t photon_count(const gpu::RenderParams& params) {
  const uint64_t wanted = uint64_t{8} * params.film_width * params.film_width;
  return static_cast<uint32_t>(std::bit_floor(std::clamp<uint64_t>(wanted, 1u << 18, 1u << gpu::kPhotonBits)));
}

float guide_scale(const gpu::RenderParams& params) {
  const double across = std::abs(params.camera.scale_offset.x) * static_cast<double>(params.film_width);
  return static_cast<float>(across / kCellsAcross);
}

bool guide_pays(std::span<const uint32_t> flux, uint32_t caustics) {
  double all = 0;
  for (const uint32_t f : flux) all += f;
  return all > 0 && caustics / gpu::kCausticUnit >= kCausticShare * all / gpu::kPhotonUnit;
}

void build_guide(std::span<const uint32_t> flux, uint32_t focusers, std::span<glm::uvec2> guide) {
  const size_t cell_bins = size_t{kGuideCellBins} * (1 + focusers), cells = flux.size() / cell_bins;
  parallel_for(0, cells, 64, [&](size_t first, size_t last) {
    for (size_t cell = first; cell < last; ++cell)
      build_cell(flux.subspan(cell * cell_bins, cell_bins), guide.subspan(cell * cell_bins, cell_bins));
  });
  build_table({}, 0, kSharp, guide.subspan(cells * cell_bins, kGuideCellBins));
}

}  // namespace tachylite
