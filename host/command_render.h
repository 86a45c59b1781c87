#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "base/progress.h"
#include "command_film.h"
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
  std::optional<std::filesystem::path> resume;  // a film to go on with; empty: that of the first .exr of `outputs`
  bool sums = true;                             // .exr files hold what merging and resuming need
  double time = 0, error = 0;  // limits: seconds, relative standard error of the mean pixel; 0: none
  std::string device;
  bool adaptive = false;
  SamplerKind sampler = SamplerKind::kSobol;
  Guiding guiding = Guiding::kAuto;
  uint32_t max_paths = RenderOptions{}.max_paths;
  uint32_t devices = 0;  // side by side; 0: as many as pay
  std::filesystem::path stats;  // empty: none
  bool quiet = false;
};

/// Samples a pixel where a limit of time or error, not their number, ends the render.
constexpr uint64_t kEndlessSamples = uint64_t{1} << 20;
uint64_t wanted_samples(const RenderArguments& arguments, const Sensor& sensor);

/// The fraction that counts is that of the nearest end: samples, time or error.
ProgressFigures limit_fraction(ProgressFigures figures, const RenderArguments& arguments);

/// Where images go, before anything is computed: --resume FILE without -o goes on in that file. Throws InputError.
OutputFiles render_outputs(const RenderArguments& arguments);

/// Where --resume is given: the film to go on with, to the samples [first_sample, first_sample + samples). `empty` is
/// the film of this render, before its first sample; it can be continued at multiples of `block` samples. Throws
/// InputError.
std::optional<FilmBuffer> begun_film(const RenderArguments& arguments, const OutputFiles& outputs,
                                     const RenderIdentity& identity, const FilmBuffer& empty, uint64_t samples,
                                     uint64_t block);

/// What a render came to.
struct FinishedRender {
  FilmBuffer film;
  RunStatistics statistics;  // all but the seconds of writing and in total
  RenderIdentity identity;   // for the image's attributes
  bool interrupted = false;
};
/// Writes images, with attributes of their making, and statistics, and says so. `total` runs since the start.
/// Returns the exit code. Throws RenderError.
int write_render(const RenderArguments& arguments, const OutputFiles& outputs, FinishedRender& render,
                 const Timer& total);

/// Renders on a Vulkan device. Returns the exit code.
int run_render(const RenderArguments& arguments);

}  // namespace tachylite
