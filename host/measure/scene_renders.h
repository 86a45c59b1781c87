#pragma once

#include <memory>
#include <string>
#include <vector>

#include "measure/measurement.h"
#include "wavefront/renderer.h"

namespace tachylite {

/// Tachylite's own renders of a scene that is loaded and packed.
class SceneRenders {
 public:
  /// `packed` and `device` must outlive this. `before`: what it took to get so far.
  SceneRenders(vulkan::Device& device, const PackedScene& packed, const RenderOptions& options, Seconds before);

  /// Builds the kernels and renders. Throws RenderError, also when contributions were not finite.
  TimedImage render(uint64_t samples, uint32_t seed) const;

  /// The stages' times on the device over a render of so many samples, the slowest first; and what compiling took.
  std::vector<StageTime> stage_times(uint64_t samples) const;
  Seconds compile() const { return compile_; }  // of the last render

 private:
  vulkan::Device& device_;
  const PackedScene& packed_;
  RenderOptions options_;
  Seconds before_;
  mutable Seconds compile_;
};

}  // namespace tachylite
