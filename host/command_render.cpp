#include "command_render.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "command_device.h"
#include "command_interrupt.h"

namespace tachylite {
namespace {

RenderOptions render_options(const RenderArguments& arguments, const Sensor& sensor) {
  RenderOptions options;
  options.samples = wanted_samples(arguments, sensor);
  options.first_sample = arguments.first_sample;
  options.seed = arguments.seed.value_or(sensor.seed);
  options.sampler = arguments.sampler;
  options.max_paths = arguments.max_paths;
  options.time_limit = arguments.time;
  options.error_limit = arguments.error;
  options.timing = !arguments.stats.empty();
  return options;
}

RunStatistics statistics_of(const vulkan::DeviceInfo& device, const Renderer& renderer, const Scene& scene,
                            const PackedScene& packed) {
  const RenderStatistics& r = renderer.statistics();
  RunStatistics s;
  s.device = {{"name", device.name},
              {"type", device_type(device.type)},
              {"driver", device.driver},
              {"driver_version", device.driver_version},
              {"api", device.api_version}};
  s.paths = r.paths;
  s.seconds.bvh = packed.bvh_seconds;
  s.seconds.pack = packed.pack_seconds;
  s.seconds.upload = r.upload_seconds;
  s.seconds.compile = r.compile_seconds;
  s.seconds.render = r.render_seconds;
  s.closest_rays = r.closest_rays;
  s.shadow_rays = r.shadow_rays;
  s.nonfinite = r.nonfinite;
  s.overflow = r.overflow;
  s.triangles = count_triangles(scene);
  s.device_bytes = r.device_bytes;
  s.stages_run = renderer.stages_run();
  s.stages_skipped = renderer.stages_skipped();
  for (const auto& [name, time] : r.kernels) s.kernels.push_back({name, time.dispatches, time.seconds});
  return s;
}

}  // namespace

uint64_t wanted_samples(const RenderArguments& arguments, const Sensor& sensor) {
  if (arguments.samples) return *arguments.samples;
  return arguments.time > 0 || arguments.error > 0 ? kEndlessSamples
                                                   : static_cast<uint64_t>(sensor.sample_count);
}

ProgressFigures limit_fraction(ProgressFigures figures, const RenderArguments& arguments) {
  if (figures.target_samples == kEndlessSamples) figures.target_samples = 0;
  if (arguments.time > 0) figures.fraction = std::max(figures.fraction, figures.seconds / arguments.time);
  if (arguments.error > 0 && figures.relative_error > 0) {  // error ~ samples^(-1/2)
    const double ratio = arguments.error / figures.relative_error;
    figures.fraction = std::max(figures.fraction, ratio * ratio);
  }
  return figures;
}

int write_render(const RenderArguments& arguments, const OutputFiles& outputs, FinishedRender& render,
                 const Timer& total) {
  RunStatistics& statistics = render.statistics;
  if (statistics.overflow > 0)
    throw RenderError(
        fmt::format("{} entries overflowed their queues; nothing is written", statistics.overflow));
  if (statistics.nonfinite > 0)
    log_warning(fmt::format("{} contributions were not finite and count as 0", statistics.nonfinite));
  if (statistics.spp == 0) {
    log_info("interrupted before the first samples were finished; nothing is written");
    return kExitInterrupted;
  }
  const Timer write_timer;
  render.image.metadata = {{"scene", arguments.scene.file.string()},
                           {"spp", fmt::format("{}", statistics.spp)},
                           {"first_sample", fmt::format("{}", arguments.first_sample)},
                           {"seed", fmt::format("{}", render.seed)},
                           {"device", render.device},
                           {"driver", render.driver},
                           {"version", TACHYLITE_VERSION},
                           {"seconds", fmt::format("{:.3f}", statistics.seconds.render)}};
  write_outputs(outputs, render.image);
  statistics.seconds.write = write_timer.seconds();
  statistics.seconds.total = total.seconds();
  if (!arguments.stats.empty()) write_statistics(arguments.stats, statistics);

  std::string line =
      fmt::format("{}{} samples in {} ({:.3g} Mpaths/s)", render.interrupted ? "interrupted after " : "",
                  statistics.spp, format_duration(statistics.seconds.render), statistics.mpaths_per_s());
  if (render.relative_error > 0)
    line += fmt::format(", relative error {:.2g} %", 100 * render.relative_error);
  for (const std::filesystem::path& file : outputs) line += fmt::format(", {}", file.string());
  log_info(line);
  return render.interrupted ? kExitInterrupted : 0;
}

int run_render(const RenderArguments& arguments) {
  // Refuse what cannot succeed before the long work begins.
  const Timer total;
  const OutputFiles outputs = check_outputs(arguments.outputs, arguments.scene.file);
  if (!arguments.stats.empty()) check_writable(arguments.stats);

  const Scene scene = load_scene_of(arguments.scene);
  const double load_seconds = total.seconds();
  const Sensor& sensor = scene.sensors[static_cast<size_t>(arguments.scene.sensor)];
  vulkan::Device device(device_options(arguments.device));
  log_info(fmt::format("{}; on {}", summarize(scene, arguments.scene.sensor), describe(device.info())));
  const PackedScene packed = pack_scene(scene, arguments.scene.sensor);

  RenderOptions options = render_options(arguments, sensor);
  InterruptScope interrupt;
  ProgressDisplay display(arguments.quiet);
  options.progress = [&](const RenderProgress& progress) {
    display.update(limit_fraction({progress.fraction, progress.samples, progress.target_samples,
                                   progress.seconds, progress.mpaths_per_s, progress.relative_error},
                                  arguments));
    return !interrupt.requested();
  };
  Renderer renderer(device, packed, options);
  log_info(fmt::format("runs: {}", fmt::join(renderer.stages_run(), ", ")));
  log_info(fmt::format("skipped: {}", fmt::join(renderer.stages_skipped(), ", ")));
  const FilmBuffer film = renderer.render();
  display.finish();
  check_validation(device);

  FinishedRender finished;
  finished.image = film.to_image();
  finished.statistics = statistics_of(device.info(), renderer, scene, packed);
  finished.statistics.spp = film.samples();
  finished.statistics.seconds.load = load_seconds;
  finished.device = device.info().name;
  finished.driver = fmt::format("{} {}", device.info().driver, device.info().driver_version);
  finished.seed = options.seed;
  finished.relative_error = film.relative_error();
  finished.interrupted = interrupt.requested();
  return write_render(arguments, outputs, finished, total);
}

}  // namespace tachylite
