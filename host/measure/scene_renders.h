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
  /// `packed` and `devices` must outlive this. `before`: what it took to get so far.
  SceneRenders(vulkan::DevicePool& devices, const PackedScene& packed, const RenderOptions& options, Seconds before);

  /// Builds the kernels and renders, on as many devices as pay. Throws RenderError, also when contributions were not
  /// finite.
  TimedImage render(uint64_t samples, uint32_t seed) const;

  /// The stages' times on one device over a render of so many samples, the slowest first; and what compiling took.
  std::vector<StageTime> stage_times(uint64_t samples) const;
  Seconds compile() const { return compile_; }  // of the last render

 private:
  vulkan::DevicePool& devices_;
  const PackedScene& packed_;
  RenderOptions options_;
  Seconds before_;
  mutable Seconds compile_;
};

}  // namespace tachylite
