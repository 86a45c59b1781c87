#include "measure/scene_renders.h"

#include <algorithm>

#include "base/error.h"
#include "base/timer.h"
#include "measure/image_error.h"

namespace tachylite {

SceneRenders::SceneRenders(vulkan::DevicePool& devices, const PackedScene& packed, const RenderOptions& options,
                           Seconds before)
    : devices_(devices), packed_(packed), options_(options), before_(before) {}

TimedImage SceneRenders::render(uint64_t samples, uint32_t seed) const {
  RenderOptions options = options_;
  options.samples = samples;
  options.seed = seed;
  const vulkan::DevicePool::Devices devices =
      devices_.side_by_side(count_devices(devices_.one().info(), packed_, options));
  const Timer wall;
  const CpuTimer cpu;
  Renderer renderer(devices, packed_, options);
  compile_ = {cpu.seconds(), wall.seconds()};
  const FilmBuffer film = renderer.render();
  TimedImage result;
  const Seconds all{cpu.seconds(), wall.seconds()};
  result.render = {all.cpu - compile_.cpu, all.wall - compile_.wall};
  result.total = {before_.cpu + all.cpu, before_.wall + all.wall};
  const RenderStatistics& statistics = renderer.statistics();
  if (!options.adaptive && film.samples() < samples) throw RenderError("interrupted");
  if (statistics.nonfinite > 0 || statistics.overflow > 0)
    throw RenderError(fmt::format("{} contributions were not finite, {} did not fit their queues",
                                  statistics.nonfinite, statistics.overflow));
  result.image = color_of(film.to_image());
  return result;
}

std::vector<StageTime> SceneRenders::stage_times(uint64_t samples) const {
  RenderOptions options = options_;
  options.samples = samples;
  options.timing = true;
  Renderer renderer(devices_.one(), packed_, options);
  renderer.render();
  std::vector<StageTime> stages;
  for (const auto& [name, time] : renderer.statistics().kernels)
    stages.push_back({name, time.dispatches, time.seconds});
  std::sort(stages.begin(), stages.end(), [](const StageTime& a, const StageTime& b) { return a.seconds > b.seconds; });
  return stages;
}

}  // namespace tachylite
