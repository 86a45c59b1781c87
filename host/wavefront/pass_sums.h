#pragma once

#include <vector>

#include "image/film.h"
#include "pack/pack_scene.h"

namespace tachylite {

/// The sums of one pass: a few blocks of samples of all pixels, gathered wave by wave as the device wrote them (tile
/// order) and added to the film at once, so that an interrupted pass leaves no trace there.
class PassSums {
 public:
  PassSums(const gpu::RenderParams& params, uint32_t blocks, const PackedScene& scene);

  std::vector<std::string> extra_channels() const;

  /// film, aov: the device's blocks after `wave`; aov may be null.
  void take(const gpu::WaveParams& wave, const glm::vec4* film, const glm::vec4* aov);
  /// Adds block `block` of the pass, which has n samples a pixel. Does not finish the film's blocks.
  void add_block_to(FilmBuffer& film, uint32_t block, uint64_t n) const;

 private:
  gpu::RenderParams params_;
  uint32_t all_pixels_ = 0, blocks_ = 0;
  std::vector<Aov> aovs_;
  uint32_t aov_kinds_ = 0;  // set of kAov...
  glm::dvec3 centre_{0};
  std::vector<std::vector<glm::vec4>> rows_;  // film, then a row a kind of AOV; each blocks * all pixels
};

}  // namespace tachylite
