#include "command_render.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "command_device.h"
#include "command_interrupt.h"
#include "pack/bake_geometry.h"
#include "vulkan/check.h"
#include "vulkan/vector_width.h"

namespace tachylite {
namespace {

RenderOptions render_options(const RenderArguments& arguments, const Sensor& sensor) {
  RenderOptions options;
  options.samples = wanted_samples(arguments, sensor);
  options.first_sample = arguments.first_sample;
  options.seed = arguments.seed.value_or(sensor.seed);
  options.sampler = arguments.sampler;
  options.guiding = arguments.guiding;
  options.max_paths = arguments.max_paths;
  options.time_limit = arguments.time;
  options.error_limit = arguments.error;
  options.adaptive = arguments.adaptive;
  options.timing = !arguments.stats.empty();
  return options;
}

// What the numbers of a sample depend on beside the seed.
std::string sampling_name(const RenderOptions& options) {
  std::string name = options.sampler == SamplerKind::kSobol ? "sobol" : "independent";
  if (options.guiding == Guiding::kOn) name += ", guided";
  if (options.guiding == Guiding::kOff) name += ", not guided";
  return name;
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
  const bool exr = std::any_of(outputs.begin(), outputs.end(), [](const auto& file) { return file.extension() == ".exr"; });
  Image image = render.film.to_image(exr && arguments.sums && !render.film.is_adaptive());
  image.metadata.merge(render.identity);
  image.metadata.merge(std::map<std::string, std::string>{
      {"scene", arguments.scene.file.string()},
      {"spp", fmt::format("{}", statistics.spp)},
      {"first_sample", fmt::format("{}", render.film.ranges().front().first)},
      {"seconds", fmt::format("{:.3f}", statistics.seconds.render)}});
  write_outputs(outputs, image);
  statistics.seconds.write = write_timer.seconds();
  statistics.seconds.total = total.seconds();
  if (!arguments.stats.empty()) write_statistics(arguments.stats, statistics);

  std::string line =
      fmt::format("{}{}{} samples in {} ({:.3g} Mpaths/s)", render.interrupted ? "interrupted after " : "",
                  render.film.is_adaptive() ? "on average " : "", statistics.spp,
                  format_duration(statistics.seconds.render), statistics.mpaths_per_s());
  if (const double error = render.film.relative_error(); error > 0)
    line += fmt::format(", relative error {:.2g} %", 100 * error);
  for (const std::filesystem::path& file : outputs) line += fmt::format(", {}", file.string());
  log_info(line);
  return render.interrupted ? kExitInterrupted : 0;
}

OutputFiles render_outputs(const RenderArguments& arguments) {
  OutputFiles given = arguments.outputs;
  if (given.empty() && arguments.resume && !arguments.resume->empty()) given.push_back(*arguments.resume);
  return check_outputs(given, arguments.scene.file);
}

std::optional<FilmBuffer> begun_film(const RenderArguments& arguments, const OutputFiles& outputs,
                                     const RenderIdentity& identity, const FilmBuffer& empty, uint64_t samples,
                                     uint64_t block) {
  if (!arguments.resume) return std::nullopt;
  std::filesystem::path file = *arguments.resume;
  for (const std::filesystem::path& output : outputs)
    if (file.empty() && output.extension() == ".exr") file = output;
  if (file.empty()) throw InputError("--resume: no .exr is named to go on with");
  StoredFilm begun = read_film(file);
  require_same_render(begun, identity, empty, "this render");
  const SampleRange& range = begun.film.ranges().front();
  const std::string has = fmt::format("{}: holds the samples {}", begun.place, format_ranges(begun.film.ranges()));
  if (begun.film.ranges().size() > 1) throw InputError(has + ", which are not one run that could go on");
  if (range.first != arguments.first_sample)
    throw InputError(fmt::format("{}, but the first sample asked for is {} (--first-sample)", has, arguments.first_sample));
  if (range.count > samples) throw InputError(fmt::format("{}, more than the {} asked for (--spp)", has, samples));
  if (range.count < samples && range.count % block != 0)
    throw InputError(fmt::format("{}: only a multiple of {} of them can go on", has, block));
  FilmBuffer film = empty;  // with its order of channels
  film.merge(begun.film);
  return film;
}

int run_render(const RenderArguments& arguments) {
  // Refuse what cannot succeed before the long work begins.
  const Timer total;
  const OutputFiles outputs = render_outputs(arguments);
  if (!arguments.stats.empty()) check_writable(arguments.stats);

  const Scene scene = load_scene_of(arguments.scene);
  const double load_seconds = total.seconds();
  const Sensor& sensor = scene.sensors[static_cast<size_t>(arguments.scene.sensor)];
  RenderOptions options = render_options(arguments, sensor);
  std::optional<InterruptScope> interrupt;  // from when there is something to be written
  ProgressDisplay display(arguments.quiet);
  options.progress = [&](const RenderProgress& progress) {
    display.update(limit_fraction({progress.fraction, progress.samples, progress.target_samples,
                                   progress.seconds, progress.mpaths_per_s, progress.relative_error},
                                  arguments));
    return !interrupt->requested();
  };

  std::optional<FilmBuffer> film;
  std::optional<PackedScene> packed = pack_if_baked(scene, arguments.scene.sensor);
  if (packed) vulkan::prefer_wide_vectors();
  FinishedRender finished{.film = FilmBuffer(1, 1)};
  const auto attempt = [&] {
    vulkan::DevicePool pool(device_options(arguments.device));
    const vulkan::DeviceInfo& info = pool.one().info();
    if (!film) {
      log_info(fmt::format("{}; on {}", summarize(scene, arguments.scene.sensor), describe(info)));
      if (!packed) packed = pack_scene(scene, arguments.scene.sensor);
      finished.identity = render_identity(scene, arguments.scene.sensor, options.seed,
                                          sampling_name(options), info.name,
                                          fmt::format("{} {}", info.driver, info.driver_version));
      film = Renderer::new_film(*packed);
      if (std::optional<FilmBuffer> begun = begun_film(arguments, outputs, finished.identity, *film, options.samples,
                                                       gpu::kBlockSamples))
        film = std::move(begun);
    }
    const uint32_t devices = arguments.devices > 0 ? arguments.devices : count_devices(info, *packed, options);
    Renderer renderer(pool.side_by_side(devices), *packed, options);
    log_info(fmt::format("runs: {}", fmt::join(renderer.stages_run(), ", ")));
    log_info(fmt::format("skipped: {}", fmt::join(renderer.stages_skipped(), ", ")));
    if (devices > 1) log_info(fmt::format("on {} devices side by side", devices));
    if (!interrupt) interrupt.emplace();
    renderer.render_into(*film);
    display.finish();
    check_validation(pool.validation_messages());
    finished.statistics = statistics_of(info, renderer, scene, *packed);
  };
  try {
    attempt();
  } catch (const vulkan::DeviceLost& lost) {
    display.finish();
    log_warning(fmt::format("{}; trying once more{}", lost.what(),
                            film ? fmt::format(", with the {} samples that there are", film->samples()) : ""));
    attempt();
  }

  finished.film = std::move(*film);
  finished.statistics.spp = static_cast<uint64_t>(std::llround(finished.film.mean_samples()));
  finished.statistics.seconds.load = load_seconds;
  finished.interrupted = interrupt->requested();
  return write_render(arguments, outputs, finished, total);
}

}  // namespace tachylite
