#include "wavefront/pass_sums.h"

#include <algorithm>
#include <bit>

#include "base/parallel.h"
#include "shared/aov.h"

namespace tachylite {

std::optional<size_t> pixel_index(const gpu::RenderParams& params, uint32_t tile_pixel) {
  const uint32_t tile = tile_pixel / kTilePixels, inner = tile_pixel % kTilePixels;
  const size_t x = tile % params.tiles_x * gpu::kTileSize + inner % gpu::kTileSize;
  const size_t y = tile / params.tiles_x * gpu::kTileSize + inner / gpu::kTileSize;
  if (x >= params.width || y >= params.height) return std::nullopt;
  return y * params.width + x;
}

PassSums::PassSums(const gpu::RenderParams& params, uint32_t blocks, const PackedScene& scene, bool gathers)
    : params_(params),
      all_pixels_(params.tile_count * kTilePixels),
      blocks_(blocks),
      gathers_(gathers),
      aovs_(scene.aovs),
      aov_kinds_(scene.features.aovs),
      centre_(scene.centre),
      rows_(1 + static_cast<size_t>(std::popcount(scene.features.aovs))),
      gathered_(rows_.size()) {
  for (size_t row = 0; gathers_ && row < rows_.size(); ++row) rows_[row] = gather(row);
}

const glm::vec4* PassSums::gather(size_t row) {
  if (!gathered_[row]) gathered_[row] = std::make_unique_for_overwrite<glm::vec4[]>(size_t{all_pixels_} * blocks_);
  return gathered_[row].get();
}

std::vector<std::string> PassSums::extra_channels() const {
  std::vector<std::string> names;
  for (const Aov& aov : aovs_) names.insert(names.end(), aov.channels.begin(), aov.channels.end());
  return names;
}

void PassSums::take(const gpu::WaveParams& wave, const glm::vec4* film, const glm::vec4* aov) {
  for (size_t row = 0; row < rows_.size(); ++row) {
    const glm::vec4* source = row == 0 ? film : aov + (row - 1) * params_.aov_stride;
    if (!gathers_ && wave.pixel_count == all_pixels_) {
      rows_[row] = source;
      continue;
    }
    if (!gathers_) rows_[row] = gather(row);
    parallel_for_each(wave.block_count, [&](size_t b) {
      std::copy_n(source + b * wave.pixel_count, wave.pixel_count,
                  &gathered_[row][b * all_pixels_ + wave.first_pixel]);
    });
  }
}

template <class Value>
void PassSums::add_block(FilmBuffer& film, size_t pixel, uint64_t n, const Value& value) const {
  film.add_block(pixel, glm::dvec3(value(0)), n);
  size_t channel = 0;
  for (const Aov& aov : aovs_) {
    const glm::vec4 sum = value(1 + static_cast<size_t>(std::popcount(aov_kinds_ & ((1u << aov.kind) - 1))));
    // w counts the samples that hit something: their positions are relative to the centre.
    const glm::dvec3 offset = aov.kind == gpu::kAovPosition ? centre_ * double{sum.w} : glm::dvec3(0);
    for (size_t c = 0; c < aov.channels.size(); ++c) {
      const auto i = static_cast<glm::length_t>(c);
      film.add_extra(pixel, channel++, double{sum[i]} + offset[i]);
    }
  }
}

void PassSums::add_to(FilmBuffer& film, uint64_t samples) const {
  // A few rows of the film, which a cache holds, take all blocks before the next.
  parallel_for(0, params_.height, 8, [&](size_t first, size_t last) {
    for (uint64_t begin = 0; begin < samples; begin += gpu::kBlockSamples) {
      const uint64_t n = std::min<uint64_t>(gpu::kBlockSamples, samples - begin);
      for (size_t y = first; y < last; ++y)
        for (size_t x = 0; x < params_.width; ++x) {
          const size_t tile = y / gpu::kTileSize * params_.tiles_x + x / gpu::kTileSize;
          const size_t inner = y % gpu::kTileSize * gpu::kTileSize + x % gpu::kTileSize;
          const size_t source = begin / gpu::kBlockSamples * all_pixels_ + tile * kTilePixels + inner;
          add_block(film, y * params_.width + x, n, [&](size_t row) { return rows_[row][source]; });
        }
    }
  });
}

void PassSums::add_listed_to(FilmBuffer& film, const gpu::WaveParams& wave, std::span<const glm::uvec2> listed,
                             const glm::vec4* film_block, const glm::vec4* aov_block) const {
  const auto pixel_of = [&](size_t i) { return pixel_index(params_, listed[i].x).value(); };
  parallel_for(0, listed.size(), 1024, [&](size_t begin, size_t end) {
    // A pixel's blocks belong to who has the first.
    const auto goes_on = [&](size_t i) { return i > 0 && i < listed.size() && listed[i].x == listed[i - 1].x; };
    while (begin < end && goes_on(begin)) ++begin;
    while (begin < end && goes_on(end)) ++end;
    for (size_t i = begin; i < end; ++i)
      for (uint32_t b = 0; b < wave.block_count; ++b) {
        const size_t source = size_t{b} * wave.pixel_count + i;
        add_block(film, pixel_of(i), gpu::kBlockSamples, [&](size_t row) {
          return row == 0 ? film_block[source] : aov_block[(row - 1) * params_.aov_stride + source];
        });
      }
  });
  for (size_t i = 0; i < listed.size(); ++i)
    film.finish_own_blocks(pixel_of(i), wave.block_count, uint64_t{wave.block_count} * gpu::kBlockSamples);
}

}  // namespace tachylite
