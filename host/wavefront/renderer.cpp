#include "wavefront/renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "base/check.h"
#include "base/error.h"
#include "base/timer.h"
#include "shared/counters.h"
#include "shared/path_state.h"
#include "wavefront/adaptive_sampling.h"
#include "wavefront/pass_sums.h"
#include "wavefront/scene_buffers.h"
#include "wavefront/wave_tracer.h"

namespace tachylite {
namespace {

using gpu::kBlockSamples;
using gpu::WaveParams;

constexpr auto kLeastPilotBlocks = static_cast<uint32_t>(kLeastPilot / gpu::kBlockSamples);

// Paths in flight. More gain little: caches of a CPU hold few of them, and a GPU has no more lanes.
constexpr uint64_t kPathsOfCpu = 1u << 18, kPathsOfGpu = 1u << 22;
constexpr uint64_t kShareOfMemory = 8;  // all of them take at most an eighth of a GPU's

uint32_t default_paths(const PackedScene& scene, const vulkan::DeviceInfo& device) {
  if (device.type == VK_PHYSICAL_DEVICE_TYPE_CPU) return kPathsOfCpu;
  const uint64_t state = gpu::kPathRowsMedia * sizeof(glm::vec4), shadow = gpu::kShadowRowsMedia * sizeof(glm::vec4);
  const uint64_t queues = (gpu::kQueueSurface + scene.features.classes.size() + 1) * sizeof(uint32_t);
  const uint64_t fit = std::min({device.device_memory / kShareOfMemory / (state + shadow + queues),
                                 device.max_storage_buffer_range / std::max(state, queues),
                                 device.max_texel_buffer_elements * sizeof(uint32_t) / queues,
                                 device.max_texel_buffer_elements * sizeof(glm::vec4) / state});
  return static_cast<uint32_t>(std::clamp(fit, kPathsOfCpu, kPathsOfGpu));
}

RenderOptions with_defaults(RenderOptions options, const PackedScene& scene, const vulkan::DeviceInfo& device) {
  options.adaptive = options.adaptive && pilot_samples(options.samples) < options.samples;
  if (options.max_paths == 0) options.max_paths = default_paths(scene, device);
  return options;
}

}  // namespace

uint64_t MemoryPlan::total() const {
  uint64_t sum = 0;
  for (const Entry& e : buffers) sum += e.bytes;
  return sum;
}

struct Renderer::Impl {
  const PackedScene& scene;
  RenderOptions options;
  WaveTracer tracer;
  const gpu::RenderParams& params;
  RenderStatistics statistics;

  // Of the render that goes on.
  Timer timer;
  double seconds_before = 0;       // that learning the guide took, where this is the first render
  RenderProgress progress;
  uint64_t begun_paths = 0;        // that the film had before
  uint64_t estimated_samples = 0;  // when progress.relative_error was computed

  Impl(vulkan::Device& device, const PackedScene& s, const RenderOptions& o)
      : scene(s), options(with_defaults(o, s, device.info())), tracer(device, s, options), params(tracer.params()) {
    statistics.upload_seconds = tracer.upload_seconds();
    statistics.compile_seconds = tracer.compile_seconds();
    statistics.device_bytes = device.allocated_bytes();
    seconds_before = tracer.guide_seconds();
  }
  /// Passes over all pixels, to options.samples or the end of the pilot. False where the render is over.
  bool add_passes(FilmBuffer& film, PassSums& sums);
  /// What comes after the pilot.
  void add_where_noisy(FilmBuffer& film, const PassSums& sums);
  /// To the caller, who may say stop; the film has `pixel_samples_more` to come, summed over its pixels.
  bool report(const FilmBuffer& film, uint64_t pixel_samples_more);
  bool within_limits(const FilmBuffer& film);
  bool is_pilot_enough(const FilmBuffer& film) const;
  double next_samples(double samples) const;
  double seconds() const { return seconds_before + timer.seconds(); }
  static uint64_t paths_of(const FilmBuffer& film);
};

Renderer::Renderer(vulkan::Device& device, const PackedScene& scene, const RenderOptions& options) : scene_(scene) {
  if (options.first_sample % kBlockSamples != 0)
    throw InputError(fmt::format("--first-sample must be a multiple of {}", kBlockSamples));
  if (options.samples == 0 || options.samples > kMostSamples || options.first_sample > kMostSamples - options.samples)
    throw InputError(fmt::format("samples must lie in 1..{} together with the first sample", kMostSamples));
  const MemoryPlan plan = plan_memory(device.info(), scene, options);
  for (const MemoryPlan::Entry& e : plan.buffers)
    if (e.bytes > e.limit)
      throw RenderError(fmt::format("{} need {} bytes, but a buffer on {} holds at most {}", e.name, e.bytes,
                                    device.info().name, e.limit));
  if (plan.total() > device.info().device_memory)
    throw RenderError(fmt::format("the render needs {} bytes of device memory, but {} has {}", plan.total(),
                                  device.info().name, device.info().device_memory));
  impl_ = std::make_unique<Impl>(device, scene, options);
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
  PassSums sums(r.params, r.tracer.most_blocks(), r.scene);
  const bool goes_on = r.add_passes(film, sums);
  if (goes_on && r.options.adaptive && film.has_variance()) r.add_where_noisy(film, sums);
  r.statistics.render_seconds = r.seconds();
  r.seconds_before = 0;
  r.statistics.kernels = r.tracer.kernel_times();
  r.statistics.paths = r.paths_of(film) - r.begun_paths;
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

bool Renderer::Impl::add_passes(FilmBuffer& film, PassSums& sums) {
  if (!film.sampling_density().empty()) return true;
  const uint32_t all_pixels = params.tile_count * kTilePixels;
  const uint64_t first_block = options.first_sample / kBlockSamples;
  const uint64_t wanted = options.adaptive ? pilot_samples(options.samples) : options.samples;
  if (film.samples() >= wanted) return true;
  const uint64_t end_sample = options.first_sample + wanted;
  const uint64_t end_block = (end_sample + kBlockSamples - 1) / kBlockSamples;
  for (uint64_t block = first_block + film.samples() / kBlockSamples; block < end_block;) {
    // One pass: a few blocks of samples for all pixels.
    WaveParams wave{};
    wave.first_block = static_cast<uint32_t>(block);
    wave.block_count = static_cast<uint32_t>(std::min<uint64_t>(tracer.most_blocks(), end_block - block));
    // A pilot that time or error end is doubled from pass to pass.
    if (options.adaptive)
      wave.block_count = std::min(wave.block_count, std::max(static_cast<uint32_t>(film.blocks()), kLeastPilotBlocks));
    const auto goes_on = [&](uint32_t pixels_done) {
      const double done = static_cast<double>(pixels_done) / all_pixels * static_cast<double>(film.pixels());
      return report(film, static_cast<uint64_t>(done * wave.block_count * kBlockSamples));
    };
    bool stop = false;
    for (uint32_t pixel = 0; pixel < all_pixels && !stop; pixel += wave.pixel_count) {
      wave.first_pixel = pixel;
      wave.pixel_count = std::min(tracer.pixels_per_wave(), all_pixels - pixel);
      if (options.adaptive) tracer.list_pixels(consecutive_pixels(wave));
      if (!tracer.trace(wave, [&] { return goes_on(pixel); }, statistics)) return false;
      sums.take(wave, tracer.film(), tracer.aovs());
      stop = !goes_on(pixel + wave.pixel_count);
      if (stop && pixel + wave.pixel_count < all_pixels) return false;
    }

    // Add the pass to the film.
    const uint64_t first = block * kBlockSamples, n = wave.block_count * kBlockSamples;
    const SampleRange samples{first, std::min<uint64_t>(n, end_sample - first)};
    sums.add_to(film, samples.count);
    film.finish_blocks(samples, wave.block_count);
    block += wave.block_count;
    if (!within_limits(film) || stop) return false;
    if (is_pilot_enough(film)) break;
  }
  return true;
}

// Mean samples after the next pass of adaptive sampling: doubled, unless a limit comes before.
double Renderer::Impl::next_samples(double samples) const {
  double factor = 2;
  if (options.error_limit > 0) factor = std::min(factor, std::pow(progress.relative_error / options.error_limit, 2));
  if (options.time_limit > 0) factor = std::min(factor, options.time_limit / seconds());
  return samples * std::max(factor, 1.05);
}

void Renderer::Impl::add_where_noisy(FilmBuffer& film, const PassSums& sums) {
  if (film.sampling_density().empty()) film.set_sampling_density(sampling_density(film));
  const auto first_block = static_cast<uint32_t>(options.first_sample / kBlockSamples);
  const auto most = static_cast<double>(options.samples);
  // Many blocks a lane even out the lengths of paths, few follow the density.
  const uint64_t few = tracer.follows_whole_paths() ? std::min<uint64_t>(film.blocks() / 2, tracer.most_blocks()) : 1;
  const auto chunk = static_cast<uint32_t>(std::bit_floor(few));
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

    WaveParams wave{};
    wave.block_count = chunk;
    for (size_t first = 0; first < listed.size(); first += wave.pixel_count) {
      const size_t rows = size_t{tracer.pixels_per_wave()} * tracer.most_blocks() / chunk;
      wave.pixel_count = static_cast<uint32_t>(std::min(rows, listed.size() - first));
      const std::span<const glm::uvec2> of_wave = std::span(listed).subspan(first, wave.pixel_count);
      tracer.list_pixels(of_wave);
      if (!tracer.trace(wave, [&] { return report(film, 0); }, statistics)) return;
      sums.add_listed_to(film, wave, of_wave, tracer.film(), tracer.aovs());
      if (!report(film, 0)) return;
      if (options.time_limit > 0 && seconds() >= options.time_limit) return;
    }
    if (!within_limits(film)) return;
  }
}

const RenderStatistics& Renderer::statistics() const { return impl_->statistics; }
std::vector<std::string> Renderer::stages_run() const { return impl_->tracer.kernels().run; }
std::vector<std::string> Renderer::stages_skipped() const { return impl_->tracer.kernels().skipped; }

MemoryPlan Renderer::plan_memory(const vulkan::DeviceInfo& device, const PackedScene& scene,
                                 const RenderOptions& options) {
  MemoryPlan plan;
  const WavePlan waves(scene, with_defaults(options, scene, device));
  gpu::RenderParams params = scene.params;
  params.capacity = waves.capacity;
  for (const BufferPlan& p : plan_buffers(scene, params, waves, options.adaptive)) {
    uint64_t limit = std::numeric_limits<uint64_t>::max();
    for (const vulkan::Binding& b : p.bindings) limit = std::min(limit, vulkan::largest_buffer(device, b));
    if (p.bytes > 0) plan.buffers.push_back({p.name, p.bytes, limit});
  }
  return plan;
}

}  // namespace tachylite
