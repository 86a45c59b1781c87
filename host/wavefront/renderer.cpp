#include "wavefront/renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>

#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "wavefront/adaptive_sampling.h"
#include "wavefront/pass_sums.h"
#include "wavefront/render_plan.h"
#include "wavefront/wave_tracer.h"

namespace tachylite {
namespace {

using gpu::kBlockSamples;
using gpu::WaveParams;

constexpr uint64_t kLeastWave = 1u << 13;  // paths, where several devices take waves
constexpr auto kLeastPilotBlocks = static_cast<uint32_t>(kLeastPilot / gpu::kBlockSamples);

// One pass over all pixels, a few blocks of samples of each, whose waves devices take one by one.
struct Pass {
  WaveParams wave;  // without pixels
  SampleRange samples;
  PassSums sums;
  uint32_t begun_pixels = 0, finished_pixels = 0;  // in tile order
};

// How many of the listed blocks, at most `rows`, a wave takes: all of a pixel, where they fit, so that no other device
// has blocks of it which might stay after those before them were abandoned.
size_t whole_pixels(std::span<const glm::uvec2> listed, size_t rows) {
  if (rows >= listed.size()) return listed.size();
  size_t count = rows;
  while (count > 0 && listed[count].x == listed[count - 1].x) --count;
  return count > 0 ? count : rows;
}

}  // namespace

struct Renderer::Impl {
  const PackedScene& scene;
  RenderOptions options;
  std::vector<std::unique_ptr<WaveTracer>> tracers;  // one a device
  const gpu::RenderParams& params;
  bool guided = false;
  RenderStatistics statistics;

  // Of the render that goes on. Several devices: what they change, and the film, belongs to who holds the mutex.
  std::mutex mutex;
  std::condition_variable pass_added;
  bool ended = false;              // no device takes a wave any more, and waves may be abandoned
  Timer timer;
  double seconds_before = 0;       // that learning the guide took, where this is the first render
  RenderProgress progress;
  uint64_t begun_paths = 0;        // that the film had before
  uint64_t estimated_samples = 0;  // when progress.relative_error was computed

  Impl(std::span<vulkan::Device* const> devices, const PackedScene& s, const RenderOptions& o)
      : scene(s),
        options(with_defaults(o, s, devices[0]->info(), static_cast<uint32_t>(devices.size()))),
        tracers(make_tracers(devices)),
        params(tracers[0]->params()) {
    if (tracers[0]->may_guide()) learn_guide();
    run_side_by_side(tracers.size(), [&](size_t i) { tracers[i]->build_surface_kernels(guided); });
    for (const auto& tracer : tracers) {
      statistics.upload_seconds = std::max(statistics.upload_seconds, tracer->upload_seconds());
      statistics.compile_seconds = std::max(statistics.compile_seconds, tracer->compile_seconds());
    }
    for (const vulkan::Device* device : devices) statistics.device_bytes += device->allocated_bytes();
  }
  std::vector<std::unique_ptr<WaveTracer>> make_tracers(std::span<vulkan::Device* const> devices) const;
  void learn_guide();
  /// body(WaveTracer&, RenderStatistics&, std::unique_lock&) side by side: takes waves until there are none or `ended`
  /// is set, and holds the lock but while it traces.
  template <class Body>
  void trace_waves(const Body& body);
  /// action(), for who does not hold the mutex.
  template <class Action>
  auto locked(const Action& action) {
    return [&] {
      const std::lock_guard lock(mutex);
      return action();
    };
  }

  /// Passes over all pixels, to options.samples or the end of the pilot. False where the render is over.
  bool add_passes(FilmBuffer& film);
  /// What comes after the pilot.
  void add_where_noisy(FilmBuffer& film);
  /// To the caller, who may say stop; the film has `pixel_samples_more` to come, summed over its pixels.
  bool report(const FilmBuffer& film, uint64_t pixel_samples_more);
  bool within_limits(const FilmBuffer& film);
  bool is_pilot_enough(const FilmBuffer& film) const;
  double next_samples(double samples) const;
  double seconds() const { return seconds_before + timer.seconds(); }
  static uint64_t paths_of(const FilmBuffer& film);
};

Renderer::Renderer(vulkan::Device& device, const PackedScene& scene, const RenderOptions& options) : scene_(scene) {
  vulkan::Device* const only = &device;
  make(std::span(&only, 1), options);
}

Renderer::Renderer(vulkan::DevicePool::Devices devices, const PackedScene& scene, const RenderOptions& options)
    : scene_(scene) {
  std::vector<vulkan::Device*> all;
  for (const auto& device : devices) all.push_back(device.get());
  make(all, options);
}

void Renderer::make(std::span<vulkan::Device* const> devices, const RenderOptions& options) {
  if (options.first_sample % kBlockSamples != 0)
    throw InputError(fmt::format("--first-sample must be a multiple of {}", kBlockSamples));
  if (options.samples == 0 || options.samples > kMostSamples || options.first_sample > kMostSamples - options.samples)
    throw InputError(fmt::format("samples must lie in 1..{} together with the first sample", kMostSamples));
  const vulkan::DeviceInfo& info = devices[0]->info();
  const MemoryPlan plan = plan_memory(info, scene_, options, static_cast<uint32_t>(devices.size()));
  for (const MemoryPlan::Entry& e : plan.buffers)
    if (e.bytes > e.limit)
      throw RenderError(fmt::format("{} need {} bytes, but a buffer on {} holds at most {}", e.name, e.bytes,
                                    info.name, e.limit));
  if (plan.total() > info.device_memory)
    throw RenderError(fmt::format("the render needs {} bytes of device memory, but {} has {}", plan.total(), info.name,
                                  info.device_memory));
  impl_ = std::make_unique<Impl>(devices, scene_, options);
}

Renderer::~Renderer() = default;

FilmBuffer Renderer::new_film(const PackedScene& scene) {
  return FilmBuffer(static_cast<int>(scene.params.width), static_cast<int>(scene.params.height),
                    PassSums(scene.params, 0, scene).extra_channels(), scene.sample_count_channel);
}

void Renderer::render_into(FilmBuffer& film) {
  Impl& r = *impl_;
  CHECK(film.samples() == 0 || film.ranges() == (std::vector<SampleRange>{{r.options.first_sample, film.samples()}}));
  CHECK(film.samples() % kBlockSamples == 0 || film.samples() == r.options.samples);
  r.timer = Timer();
  r.progress = RenderProgress{};
  r.progress.target_samples = r.options.samples;
  r.begun_paths = r.paths_of(film);
  r.estimated_samples = 0;
  const bool goes_on = r.add_passes(film);
  if (goes_on && r.options.adaptive && film.has_variance()) r.add_where_noisy(film);
  r.statistics.render_seconds = r.seconds();
  r.seconds_before = 0;
  r.statistics.kernels.clear();
  for (const auto& tracer : r.tracers)
    for (const auto& [name, time] : tracer->kernel_times()) {
      vulkan::KernelTime& sum = r.statistics.kernels[name];
      sum.dispatches += time.dispatches;
      sum.seconds += time.seconds / static_cast<double>(r.tracers.size());
    }
  r.statistics.paths = r.paths_of(film) - r.begun_paths;
}

std::vector<std::unique_ptr<WaveTracer>> Renderer::Impl::make_tracers(std::span<vulkan::Device* const> devices) const {
  std::vector<std::unique_ptr<WaveTracer>> made(devices.size());
  const auto count = static_cast<uint32_t>(devices.size());
  run_side_by_side(count, [&](size_t i) {
    made[i] = std::make_unique<WaveTracer>(*devices[i], scene, options, TracerPlace{static_cast<uint32_t>(i), count});
  });
  return made;
}

// Photons are counted in integers: the guide does not depend on who has traced them.
void Renderer::Impl::learn_guide() {
  run_side_by_side(tracers.size(), [&](size_t i) { tracers[i]->trace_photons(); });
  for (const auto& tracer : tracers) seconds_before = std::max(seconds_before, tracer->photon_seconds());
  const Timer learning;
  for (uint32_t i = 1; i < tracers.size(); ++i) tracers[0]->add_photons(*tracers[i]);
  guided = tracers[0]->learn_guide();
  for (uint32_t i = 1; guided && i < tracers.size(); ++i) tracers[i]->copy_guide(*tracers[0]);
  seconds_before += learning.seconds();
}

template <class Body>
void Renderer::Impl::trace_waves(const Body& body) {
  ended = false;
  std::vector<RenderStatistics> counts(tracers.size());
  const auto trace = [&](size_t i) {
    std::unique_lock lock(mutex);
    try {
      body(*tracers[i], counts[i], lock);
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      ended = true;
      pass_added.notify_all();
      throw;
    }
  };
  run_side_by_side(tracers.size(), trace);
  for (const RenderStatistics& c : counts) {
    statistics.closest_rays += c.closest_rays;
    statistics.shadow_rays += c.shadow_rays;
    statistics.nonfinite += c.nonfinite;
    statistics.overflow += c.overflow;
  }
}

uint64_t Renderer::Impl::paths_of(const FilmBuffer& film) {
  return static_cast<uint64_t>(std::llround(film.mean_samples() * static_cast<double>(film.pixels())));
}

bool Renderer::Impl::report(const FilmBuffer& film, uint64_t pixel_samples_more) {
  const double pixels = static_cast<double>(film.pixels()), finished = film.mean_samples();
  const double samples = finished + static_cast<double>(pixel_samples_more) / pixels;
  progress.samples = static_cast<uint64_t>(finished);
  progress.seconds = seconds();
  progress.fraction = samples / static_cast<double>(options.samples);
  progress.mpaths_per_s = (samples * pixels - static_cast<double>(begun_paths)) * 1e-6 / progress.seconds;
  return !options.progress || options.progress(progress);
}

bool Renderer::Impl::within_limits(const FilmBuffer& film) {
  if (options.time_limit > 0 && seconds() >= options.time_limit) return false;
  // The estimate reads the whole film: anew where it decides, else when the samples have grown by a half.
  const auto samples = static_cast<uint64_t>(film.mean_samples());
  if (film.has_variance() && (options.error_limit > 0 || 2 * samples >= 3 * estimated_samples)) {
    progress.relative_error = film.relative_error();
    estimated_samples = samples;
    if (options.error_limit > 0 && progress.relative_error <= options.error_limit) return false;
  }
  return true;
}

bool Renderer::Impl::is_pilot_enough(const FilmBuffer& film) const {
  return options.adaptive && film.samples() >= kLeastPilot &&
         ((options.time_limit > 0 && seconds() >= options.time_limit / 4) ||
          (options.error_limit > 0 && progress.relative_error <= 2 * options.error_limit));
}

bool Renderer::Impl::add_passes(FilmBuffer& film) {
  if (!film.sampling_density().empty()) return true;
  const uint64_t wanted = options.adaptive ? pilot_samples(options.samples) : options.samples;
  if (film.samples() >= wanted) return true;
  const bool many = tracers.size() > 1;
  const uint32_t all_pixels = params.tile_count * kTilePixels, most_blocks = tracers[0]->most_blocks();
  const uint64_t first_block = options.first_sample / kBlockSamples, end_sample = options.first_sample + wanted;
  const uint64_t end_block = (end_sample + kBlockSamples - 1) / kBlockSamples;
  uint64_t next_block = first_block + film.samples() / kBlockSamples;
  bool goes_on = true;      // after the passes
  std::deque<Pass> passes;  // that wait for waves, or for passes before them
  bool adding = false;      // some thread adds passes to the film

  const auto begin_pass = [&] {
    WaveParams wave{};
    wave.first_block = static_cast<uint32_t>(next_block);
    wave.block_count = static_cast<uint32_t>(std::min<uint64_t>(most_blocks, end_block - next_block));
    // A pilot that time or error end is doubled from pass to pass.
    if (options.adaptive)
      wave.block_count =
          std::min(wave.block_count, std::max(static_cast<uint32_t>(next_block - first_block), kLeastPilotBlocks));
    const uint64_t first = next_block * kBlockSamples, n = wave.block_count * kBlockSamples;
    const SampleRange samples{first, std::min<uint64_t>(n, end_sample - first)};
    passes.push_back({wave, samples, PassSums(params, most_blocks, scene, many)});
    next_block += wave.block_count;
  };
  // Waves become smaller towards the end, so that no device waits long for the last one (Polychronopoulos and Kuck
  // 1987, "Guided Self-Scheduling").
  const auto share_of_rest = [&](const WaveParams& wave) {
    const uint64_t blocks_of_pixels = uint64_t{all_pixels - wave.first_pixel} * wave.block_count +
                                      (end_block - next_block) * all_pixels;
    const uint64_t share = std::max(blocks_of_pixels / (2 * tracers.size()), kLeastWave / kBlockSamples);
    return static_cast<uint32_t>(std::min<uint64_t>(share / wave.block_count + 1, all_pixels));
  };
  const auto end = [&](bool with) {
    goes_on = goes_on && with;
    ended = true;
    pass_added.notify_all();
  };
  const auto tell = [&] {
    double done = 0;
    for (const Pass& pass : passes)
      done += static_cast<double>(pass.finished_pixels) / all_pixels * static_cast<double>(film.pixels()) *
              pass.wave.block_count * kBlockSamples;
    if (!ended && !report(film, static_cast<uint64_t>(done))) end(false);
    return !ended;
  };
  const auto add_finished = [&](std::unique_lock<std::mutex>& lock) {
    if (adding) return;
    adding = true;
    while (!ended && !passes.empty() && passes.front().finished_pixels == all_pixels) {
      const Pass& pass = passes.front();
      lock.unlock();
      pass.sums.add_to(film, pass.samples.count);
      lock.lock();
      film.finish_blocks(pass.samples, pass.wave.block_count);
      passes.pop_front();
      pass_added.notify_all();
      if (!within_limits(film)) end(false);
      if (is_pilot_enough(film)) end(true);
    }
    adding = false;
  };

  trace_waves([&](WaveTracer& tracer, RenderStatistics& counts, std::unique_lock<std::mutex>& lock) {
    while (!ended) {
      if (passes.empty() || passes.back().begun_pixels == all_pixels) {
        if (next_block >= end_block) return;
        if (passes.size() > tracers.size()) {
          pass_added.wait(lock);
          continue;
        }
        begin_pass();
      }
      Pass& pass = passes.back();  // stays where it is while others come and go
      WaveParams wave = pass.wave;
      wave.first_pixel = pass.begun_pixels;
      wave.pixel_count = std::min(tracer.pixels_per_wave(), all_pixels - wave.first_pixel);
      if (many) wave.pixel_count = std::min(wave.pixel_count, share_of_rest(wave));
      pass.begun_pixels += wave.pixel_count;
      lock.unlock();
      if (options.adaptive) tracer.list_pixels(consecutive_pixels(wave));
      const bool traced = tracer.trace(wave, locked(tell), counts);
      if (traced) pass.sums.take(wave, tracer.film(), tracer.aovs());
      lock.lock();
      if (!traced || ended) return;
      pass.finished_pixels += wave.pixel_count;
      add_finished(lock);
      tell();
    }
  });
  return goes_on;
}

// Mean samples after the next pass of adaptive sampling: doubled, unless a limit comes before.
double Renderer::Impl::next_samples(double samples) const {
  double factor = 2;
  if (options.error_limit > 0) factor = std::min(factor, std::pow(progress.relative_error / options.error_limit, 2));
  if (options.time_limit > 0) factor = std::min(factor, options.time_limit / seconds());
  return samples * std::max(factor, 1.05);
}

void Renderer::Impl::add_where_noisy(FilmBuffer& film) {
  if (film.sampling_density().empty()) film.set_sampling_density(sampling_density(film));
  const auto first_block = static_cast<uint32_t>(options.first_sample / kBlockSamples);
  const auto most = static_cast<double>(options.samples);
  const WaveTracer& first_tracer = *tracers[0];
  // Many blocks a lane even out the lengths of paths, few follow the density.
  const uint64_t few =
      first_tracer.follows_whole_paths() ? std::min<uint64_t>(film.blocks() / 2, first_tracer.most_blocks()) : 1;
  const auto chunk = static_cast<uint32_t>(std::bit_floor(few));
  const PassSums sums(params, first_tracer.most_blocks(), scene);
  std::vector<glm::uvec2> listed;
  for (double samples = film.mean_samples(), last = 0; last < most; last = samples) {
    samples = std::min(next_samples(samples), most);
    const std::vector<uint32_t> blocks =
        allocate_blocks(film.sampling_density(), film.width(), static_cast<uint32_t>(film.blocks()),
                        samples / kBlockSamples, chunk);
    listed.clear();
    for (uint32_t tile_pixel = 0; tile_pixel < params.tile_count * kTilePixels; ++tile_pixel) {
      const std::optional<size_t> index = pixel_index(params, tile_pixel);
      for (uint64_t b = index ? film.blocks_of(*index) : 0; index && b < blocks[*index]; b += chunk)
        listed.emplace_back(tile_pixel, first_block + b);
    }

    std::span<const glm::uvec2> rest = listed;
    const auto tell = [&] {
      ended = ended || !report(film, 0);
      return !ended;
    };
    trace_waves([&](WaveTracer& tracer, RenderStatistics& counts, std::unique_lock<std::mutex>& lock) {
      while (!ended && !rest.empty()) {
        const size_t rows = size_t{tracer.pixels_per_wave()} * tracer.most_blocks() / chunk;
        const std::span<const glm::uvec2> of_wave = rest.first(whole_pixels(rest, rows));
        rest = rest.subspan(of_wave.size());
        WaveParams wave{};
        wave.block_count = chunk;
        wave.pixel_count = static_cast<uint32_t>(of_wave.size());
        lock.unlock();
        tracer.list_pixels(of_wave);
        const bool traced = tracer.trace(wave, locked(tell), counts);
        lock.lock();
        if (!traced || ended) return;
        sums.add_listed_to(film, wave, of_wave, tracer.film(), tracer.aovs());
        ended = !tell() || (options.time_limit > 0 && seconds() >= options.time_limit);
      }
    });
    if (ended || !within_limits(film)) return;
  }
}

const RenderStatistics& Renderer::statistics() const { return impl_->statistics; }
std::vector<std::string> Renderer::stages_run() const { return impl_->tracers[0]->kernels().run; }
std::vector<std::string> Renderer::stages_skipped() const { return impl_->tracers[0]->kernels().skipped; }

}  // namespace tachylite
