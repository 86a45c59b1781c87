#include "command_reference.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/log.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "command_interrupt.h"
#include "reference/reference.h"

namespace tachylite {

int run_reference(const RenderArguments& arguments) {
  const Timer total;
  const OutputFiles outputs = render_outputs(arguments);
  if (!arguments.stats.empty()) check_writable(arguments.stats);

  const Scene scene = load_scene_of(arguments.scene);
  const double load_seconds = total.seconds();
  const Sensor& sensor = scene.sensors[static_cast<size_t>(arguments.scene.sensor)];
  const double pixels = static_cast<double>(sensor.film.crop_width) * sensor.film.crop_height;
  log_info(fmt::format("{}; on the CPU reference, {} threads", summarize(scene, arguments.scene.sensor),
                       thread_count()));

  ReferenceOptions options;
  options.sensor = arguments.scene.sensor;
  options.samples = wanted_samples(arguments, sensor);
  options.first_sample = arguments.first_sample;
  options.seed = arguments.seed.value_or(sensor.seed);
  const RenderIdentity identity = render_identity(scene, options.sensor, options.seed, "reference", "CPU reference", "none");
  std::optional<FilmBuffer> begun;
  if (arguments.resume) {
    const FilmBuffer empty = ReferenceRenderer(scene, options.sensor).image().film;
    begun = begun_film(arguments, outputs, identity, empty, options.samples, 1);
    options.begun = &*begun;
  }
  if (arguments.time > 0) options.seconds = arguments.time;
  InterruptScope interrupt;
  ProgressDisplay display(arguments.quiet);
  ReferenceProgress last;
  options.progress = [&](const ReferenceProgress& progress) {
    last = progress;
    const double samples = static_cast<double>(progress.samples_done);
    display.update(
        limit_fraction({samples / static_cast<double>(progress.samples_wanted), progress.samples_done,
                        progress.samples_wanted, progress.seconds,
                        1e-6 * samples * pixels / std::max(progress.seconds, 1e-9), progress.relative_error},
                       arguments));
    const bool good_enough = progress.relative_error > 0 && progress.relative_error <= arguments.error;
    return !good_enough && !interrupt.requested();
  };
  const Timer render_timer;
  const ReferenceImage result = render_reference(scene, options);
  display.finish();

  FinishedRender finished{result.film, {}, identity, interrupt.requested()};
  RunStatistics& s = finished.statistics;
  s.device = {
      {"name", "CPU reference"}, {"type", "CPU"}, {"driver", fmt::format("{} threads", thread_count())}};
  s.spp = result.samples;
  s.paths = (result.samples - (begun ? begun->samples() : 0)) * result.film.pixels();
  s.seconds.load = load_seconds;
  s.seconds.render = render_timer.seconds();
  s.closest_rays = result.closest_rays;
  s.shadow_rays = result.shadow_rays;
  s.nonfinite = result.nonfinite;
  s.triangles = count_triangles(scene);
  return write_render(arguments, outputs, finished, total);
}

}  // namespace tachylite
