#include "wavefront/pass_sums.h"

#include <algorithm>
#include <bit>

#include "base/parallel.h"
#include "shared/aov.h"

namespace tachylite {
namespace {
constexpr uint32_t kTilePixels = gpu::kTileSize * gpu::kTileSize;
}

PassSums::PassSums(const gpu::RenderParams& params, uint32_t blocks, const PackedScene& scene)
    : params_(params),
      all_pixels_(params.tile_count * kTilePixels),
      blocks_(blocks),
      aovs_(scene.aovs),
      aov_kinds_(scene.features.aovs),
      centre_(scene.centre),
      rows_(1 + static_cast<size_t>(std::popcount(scene.features.aovs)),
            std::vector<glm::vec4>(size_t{all_pixels_} * blocks)) {}

std::vector<std::string> PassSums::extra_channels() const {
  std::vector<std::string> names;
  for (const Aov& aov : aovs_) names.insert(names.end(), aov.channels.begin(), aov.channels.end());
  return names;
}

void PassSums::take(const gpu::WaveParams& wave, const glm::vec4* film, const glm::vec4* aov) {
  for (size_t row = 0; row < rows_.size(); ++row) {
    const glm::vec4* source = row == 0 ? film : aov + (row - 1) * params_.aov_stride;
    for (uint32_t b = 0; b < wave.block_count; ++b)
      std::copy_n(source + size_t{b} * wave.pixel_count, wave.pixel_count,
                  rows_[row].begin() + static_cast<ptrdiff_t>(size_t{b} * all_pixels_ + wave.first_pixel));
  }
}

void PassSums::add_block_to(FilmBuffer& film, uint32_t block, uint64_t n) const {
  parallel_for(0, params_.height, 16, [&](size_t first, size_t last) {
    for (size_t y = first; y < last; ++y)
      for (size_t x = 0; x < params_.width; ++x) {
        const size_t tile = y / gpu::kTileSize * params_.tiles_x + x / gpu::kTileSize;
        const size_t inner = y % gpu::kTileSize * gpu::kTileSize + x % gpu::kTileSize;
        const size_t source = size_t{block} * all_pixels_ + tile * kTilePixels + inner;
        const size_t pixel = y * params_.width + x;
        film.add_block(pixel, glm::dvec3(rows_[0][source]), n);
        size_t channel = 0;
        for (const Aov& aov : aovs_) {
          const glm::vec4& sum = rows_[1 + static_cast<size_t>(std::popcount(aov_kinds_ & ((1u << aov.kind) - 1)))][source];
          // w counts the samples that hit something: their positions are relative to the centre.
          const glm::dvec3 offset = aov.kind == gpu::kAovPosition ? centre_ * double{sum.w} : glm::dvec3(0);
          for (size_t c = 0; c < aov.channels.size(); ++c) {
            const auto i = static_cast<glm::length_t>(c);
            film.add_extra(pixel, channel++, double{sum[i]} + offset[i]);
          }
        }
      }
  });
}

}  // namespace tachylite
