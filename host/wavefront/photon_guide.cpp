#include "wavefront/photon_guide.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "pack/float_bits.h"
#include "shared/guide.h"
#include "shared/material.h"

namespace tachylite {
namespace {

using gpu::kGuideCellBins;

// Of directions that follow the photons where there are many. The rest follow the cosine, so that no weight exceeds
// 1 / (1 - kGuidedShare) times that of an unguided sample.
constexpr double kGuidedShare = 0.85;
// Mean photons in a cell that count as much as the uniform distribution.
constexpr double kUniformPhotons = 16;
// Photons are spread over the bins beside their own, by this for a side and its square for a corner.
constexpr double kSpread = 0.2;
constexpr double kCellsAcross = 16;  // the film, at least
constexpr int kBins = gpu::kGuideBins;

using Densities = std::array<double, kGuideCellBins>;  // mean 1

// Of each bin its mean with its neighbours; sides and corners of the square have fewer.
Densities spread(std::span<const uint32_t> bins) {
  Densities mean{};
  for (int y = 0; y < kBins; ++y)
    for (int x = 0; x < kBins; ++x) {
      double sum = 0, weights = 0;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, kBins - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, kBins - 1); ++u) {
          const double weight = (u == x ? 1 : kSpread) * (v == y ? 1 : kSpread);
          sum += weight * bins[static_cast<size_t>(v * kBins + u)];
          weights += weight;
        }
      mean[static_cast<size_t>(y * kBins + x)] = sum / weights;
    }
  return mean;
}

// Vose 1991, "A Linear Algorithm for Generating Random Numbers with a Given Distribution".
void build_alias_table(const Densities& density, std::span<glm::uvec2> out) {
  std::array<double, kGuideCellBins> rest = density;
  std::array<uint32_t, kGuideCellBins> small, large;
  size_t smalls = 0, larges = 0;
  for (uint32_t i = 0; i < kGuideCellBins; ++i) (rest[i] < 1 ? small[smalls++] : large[larges++]) = i;
  const auto put = [&](uint32_t i, double stay, uint32_t other) {
    const auto threshold = static_cast<uint32_t>(std::clamp(stay * 0x1p24, 1.0, 0x1p24 - 1));
    out[i] = {threshold << 8 | other, bits(density[i])};
  };
  while (smalls > 0 && larges > 0) {
    const uint32_t s = small[--smalls], l = large[larges - 1];
    put(s, rest[s], l);
    rest[l] -= 1 - rest[s];
    if (rest[l] < 1) {
      --larges;
      small[smalls++] = l;
    }
  }
  // What is left over by rounding.
  for (const uint32_t i : std::span(small.data(), smalls)) put(i, 1, i);
  for (const uint32_t i : std::span(large.data(), larges)) put(i, 1, i);
}

}  // namespace

bool can_be_guided(const MaterialClass& c) {
  return c.bsdfs == 1u << gpu::kBsdfDiffuse && c.max_leaves == 1 && (c.flags & gpu::kMaterialNestedFrames) == 0;
}

bool may_be_guided(const PackedScene& scene, Guiding guiding) {
  const FeatureSet& f = scene.features;
  constexpr uint32_t kAreaLights = (2u << gpu::kLightCylinder) - 1, kKinds = (2u << gpu::kLightDirectionalArea) - 1;
  constexpr uint32_t kFocus = 1u << gpu::kBsdfConductor | 1u << gpu::kBsdfRoughConductor |
                              1u << gpu::kBsdfDielectric | 1u << gpu::kBsdfRoughDielectric;
  if (guiding == Guiding::kOff || scene.emission.empty() || (f.lights & kKinds & ~kAreaLights) != 0) return false;
  if (f.media != 0 || f.max_depth <= 2 || f.strategy != gpu::kStrategyMis) return false;
  const auto focuses = [](const MaterialClass& c) { return (c.bsdfs & kFocus) != 0; };
  return std::any_of(f.classes.begin(), f.classes.end(), can_be_guided) &&
         (guiding == Guiding::kOn || std::any_of(f.classes.begin(), f.classes.end(), focuses));
}

uint32_t photon_count(const gpu::RenderParams& params) {
  const uint64_t wanted = uint64_t{8} * params.film_width * params.film_width;
  return static_cast<uint32_t>(std::bit_floor(std::clamp<uint64_t>(wanted, 1u << 18, 1u << 20)));
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

std::vector<glm::uvec2> build_guide(std::span<const uint32_t> flux) {
  std::vector<glm::uvec2> guide(flux.size());
  parallel_for(0, flux.size() / kGuideCellBins, 64, [&](size_t first, size_t last) {
    for (size_t cell = first; cell < last; ++cell) {
      const auto bins = flux.subspan(cell * kGuideCellBins, kGuideCellBins);
      double photons = 0;
      for (const uint32_t f : bins) photons += f / gpu::kPhotonUnit;
      if (photons == 0) {
        for (uint32_t i = 0; i < kGuideCellBins; ++i)
          guide[cell * kGuideCellBins + i] = {0xffffff00u | i, bits(1)};
        continue;
      }
      Densities density = spread(bins);
      double sum = 0;
      for (const double d : density) sum += d;
      const double share = kGuidedShare * photons / (photons + kUniformPhotons);
      for (double& d : density) d = 1 - share + share * kGuideCellBins * d / sum;
      build_alias_table(density, std::span(guide).subspan(cell * kGuideCellBins, kGuideCellBins));
    }
  });
  return guide;
}

}  // namespace tachylite
