#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "base/progress.h"
#include "command_output.h"
#include "command_scene.h"
#include "command_stats.h"
#include "wavefront/renderer.h"

namespace tachylite {

/// What `render` and `reference` are told; what is not given comes from the scene.
struct RenderArguments {
  SceneArguments scene;
  OutputFiles outputs;
  std::optional<uint64_t> samples;  // per pixel
  std::optional<uint32_t> seed;
  uint64_t first_sample = 0;
  double time = 0, error = 0;  // limits: seconds, relative standard error of the mean pixel; 0: none
  std::string device;
  SamplerKind sampler = SamplerKind::kSobol;
  uint32_t max_paths = RenderOptions{}.max_paths;
  std::filesystem::path stats;  // empty: none
  bool quiet = false;
};

/// Samples a pixel where a limit of time or error, not their number, ends the render.
constexpr uint64_t kEndlessSamples = uint64_t{1} << 20;
uint64_t wanted_samples(const RenderArguments& arguments, const Sensor& sensor);

/// The fraction that counts is that of the nearest end: samples, time or error.
ProgressFigures limit_fraction(ProgressFigures figures, const RenderArguments& arguments);

/// What a render came to.
struct FinishedRender {
  Image image;
  RunStatistics statistics;    // all but the seconds of writing and in total
  std::string device, driver;  // for the image's attributes
  uint32_t seed = 0;
  double relative_error = 0;  // 0: unknown
  bool interrupted = false;
};
/// Writes images, with attributes of their making, and statistics, and says so. `total` runs since the start.
/// Returns the exit code. Throws RenderError.
int write_render(const RenderArguments& arguments, const OutputFiles& outputs, FinishedRender& render,
                 const Timer& total);

/// Renders on a Vulkan device. Returns the exit code.
int run_render(const RenderArguments& arguments);

}  // namespace tachylite
