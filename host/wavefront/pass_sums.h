#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "image/film.h"
#include "pack/pack_scene.h"

namespace tachylite {

constexpr uint32_t kTilePixels = gpu::kTileSize * gpu::kTileSize;

/// Place in the image (row-major) of a pixel in tile order; none outside.
std::optional<size_t> pixel_index(const gpu::RenderParams& params, uint32_t tile_pixel);

/// The sums of one pass: a few blocks of samples of all pixels, gathered wave by wave as the device wrote them (tile
/// order) and added to the film at once, so that an interrupted pass leaves no trace there.
class PassSums {
 public:
  /// gathers: copies waves also where they have all pixels, so that the device may go on before add_to().
  PassSums(const gpu::RenderParams& params, uint32_t blocks, const PackedScene& scene, bool gathers = false);

  std::vector<std::string> extra_channels() const;

  /// Adaptive sampling: adds the blocks of a wave whose pixels are `listed` (pixel in tile order, first block; those of
  /// one pixel side by side) to the film, and counts them. Nothing is taken before.
  void add_listed_to(FilmBuffer& film, const gpu::WaveParams& wave, std::span<const glm::uvec2> listed,
                     const glm::vec4* film_block, const glm::vec4* aov_block) const;

  /// film, aov: the device's blocks after `wave`; aov may be null. Of a wave with all pixels they are not copied, but read
  /// by add_to(), unless this gathers; then several threads may call it, with different pixels.
  void take(const gpu::WaveParams& wave, const glm::vec4* film, const glm::vec4* aov);
  /// Adds the pass, which has `samples` samples a pixel. Does not finish the film's blocks.
  void add_to(FilmBuffer& film, uint64_t samples) const;

 private:
  /// value(row): of film (0) and each kind of AOV.
  template <class Value>
  void add_block(FilmBuffer& film, size_t pixel, uint64_t n, const Value& value) const;
  const glm::vec4* gather(size_t row);  // memory for it

  gpu::RenderParams params_;
  uint32_t all_pixels_ = 0, blocks_ = 0;
  bool gathers_ = false;
  std::vector<Aov> aovs_;
  uint32_t aov_kinds_ = 0;  // set of kAov...
  glm::dvec3 centre_{0};
  // Film, then a row a kind of AOV, of blocks * all pixels: the device's, or gathered.
  std::vector<const glm::vec4*> rows_;
  std::vector<std::unique_ptr<glm::vec4[]>> gathered_;
};

}  // namespace tachylite
