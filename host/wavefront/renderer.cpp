#include "wavefront/renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "base/check.h"
#include "base/error.h"
#include "base/timer.h"
#include "shared/bindings.h"
#include "shared/counters.h"
#include "shared/path_state.h"
#include "wavefront/adaptive_sampling.h"
#include "wavefront/kernels.h"
#include "wavefront/pass_sums.h"
#include "wavefront/scene_buffers.h"

namespace tachylite {
namespace {

using gpu::kBlockSamples;
using gpu::WaveParams;
using vulkan::Buffer;

constexpr uint64_t kMostSamples = uint64_t{1} << 24;  // of a pixel
constexpr uint32_t kTilePixels = gpu::kTileSize * gpu::kTileSize;
constexpr uint32_t kFusedPaths = 1u << 24;  // at most, of one dispatch that follows whole paths
constexpr uint32_t kFirstFusedPaths = 1u << 20;  // of the first: less than a second on one slow core
constexpr uint32_t kFusedBlocks = 8;
constexpr auto kLeastPilotBlocks = static_cast<uint32_t>(kLeastPilot / gpu::kBlockSamples);
constexpr uint32_t kBouncesPerSubmit = 16;  // between two looks at the queue's length; fewer where they take longer
constexpr double kLongestSubmission = 0.3;  // seconds

// Paths in flight: whole tiles of whole blocks, no more than the render has.
uint32_t capacity_for(const gpu::RenderParams& params, const RenderOptions& options) {
  const uint64_t blocks = (options.samples + kBlockSamples - 1) / kBlockSamples;
  const uint64_t all = uint64_t{params.tile_count} * kTilePixels * kBlockSamples * blocks;
  const uint64_t step = kTilePixels * kBlockSamples;
  const uint64_t wanted = std::min<uint64_t>(std::max<uint64_t>(options.max_paths, step), all);
  return static_cast<uint32_t>(wanted / step * step);
}

// A wave: blocks of samples of a range of pixels (tile order) that fit into the path slots together.
struct WaveSize {
  uint32_t pixels = 0, blocks = 0;
};
WaveSize wave_size(const gpu::RenderParams& params, const RenderOptions& options, uint32_t capacity, bool fused) {
  const uint32_t all_pixels = params.tile_count * kTilePixels;
  WaveSize size;
  if (fused) {
    // A lane renders all blocks of its pixel: many even out the lengths of paths.
    const uint64_t blocks = (options.samples + kBlockSamples - 1) / kBlockSamples;
    size.pixels = std::min(all_pixels, kFusedPaths / kBlockSamples);
    size.blocks = static_cast<uint32_t>(
        std::min<uint64_t>({blocks, kFusedBlocks, std::max(1u, kFusedPaths / (size.pixels * kBlockSamples))}));
    return size;
  }
  size.pixels = std::min(all_pixels, capacity / kBlockSamples);
  size.blocks = std::max(1u, capacity / (size.pixels * kBlockSamples));
  return size;
}

// The samples of every pixel lie below this index.
uint64_t end_of_samples(const RenderOptions& options) {
  const uint64_t share = options.adaptive ? uint64_t{kLargestShare} : 1;
  return std::min(options.first_sample + share * options.samples, kMostSamples);
}

std::optional<BakedGeometry> choose_baked(const PackedScene& scene, const RenderOptions& options) {
  if (options.structure == KernelStructure::kStages) return std::nullopt;
  std::optional<BakedGeometry> baked = bake_geometry(scene);
  if (!baked && options.structure == KernelStructure::kFused)
    throw InputError("the scene does not fit into one kernel: it is too large, or has materials or textures that need stages");
  return baked;
}

}  // namespace

uint64_t MemoryPlan::total() const {
  uint64_t sum = 0;
  for (const Entry& e : buffers) sum += e.bytes;
  return sum;
}

struct Renderer::Impl {
  vulkan::Device& device;
  const PackedScene& scene;
  const FeatureSet& features;
  RenderOptions options;
  std::optional<BakedGeometry> baked;  // one kernel for whole paths
  gpu::RenderParams params;
  uint32_t capacity = 0;
  uint32_t bounces_per_submit = kBouncesPerSubmit;
  uint32_t pixels_per_wave = 0;
  WaveSize size;
  RenderStatistics statistics;
  std::vector<Buffer> buffers;
  Buffer* counters = nullptr;
  Buffer* film_block = nullptr;
  Buffer* aov_block = nullptr;   // null: no auxiliary channels
  Buffer* pixel_list = nullptr;  // null: pixels are not listed
  std::unique_ptr<vulkan::BindingTable> table;
  Kernels kernels;
  vulkan::Commands commands;

  // Of the render that goes on.
  Timer timer;
  RenderProgress progress;
  uint64_t begun_paths = 0;        // that the film had before
  uint64_t estimated_samples = 0;  // when progress.relative_error was computed

  Impl(vulkan::Device& d, const PackedScene& s, const RenderOptions& o);
  /// False where `goes_on`, which is asked now and then, said so: the wave is abandoned.
  bool render_wave(WaveParams wave, const std::function<bool()>& goes_on);
  /// Passes over all pixels, to options.samples or the end of the pilot. False where the render is over.
  bool add_passes(FilmBuffer& film, PassSums& sums);
  /// What comes after the pilot.
  void add_where_noisy(FilmBuffer& film, const PassSums& sums);
  /// To the caller, who may say stop; the film has `pixel_samples_more` to come, summed over its pixels.
  bool report(const FilmBuffer& film, uint64_t pixel_samples_more);
  bool within_limits(const FilmBuffer& film);
  bool is_pilot_enough(const FilmBuffer& film) const;
  double next_samples(double samples) const;
  static uint64_t paths_of(const FilmBuffer& film);
  void list_pixels(const WaveParams& wave);
  const glm::vec4* mapped_film() const { return static_cast<const glm::vec4*>(film_block->mapped()); }
  const glm::vec4* mapped_aovs() const { return aov_block ? static_cast<const glm::vec4*>(aov_block->mapped()) : nullptr; }
  void record_bounce(WaveParams& wave);
  void dispatch_pixels(const Kernels::Pointer& kernel, const WaveParams& wave);
  void warm_up();
  uint64_t last_bounce() const;
  void take_counters();
};

Renderer::Impl::Impl(vulkan::Device& d, const PackedScene& s, const RenderOptions& o)
    : device(d), scene(s), features(scene.features), options(o), params(scene.params), commands(d) {
  options.adaptive = options.adaptive && pilot_samples(options.samples) < options.samples;
  baked = choose_baked(scene, options);
  params.capacity = capacity = capacity_for(params, options);
  size = wave_size(params, options, capacity, baked.has_value());
  pixels_per_wave = baked ? std::min(size.pixels, kFirstFusedPaths / (size.blocks * kBlockSamples)) : size.pixels;
  params.seed = options.seed;
  params.end_sample = static_cast<uint32_t>(end_of_samples(options));

  params.aov_stride = size.pixels * size.blocks;

  Timer upload;
  std::vector<BufferPlan> plan = 
      plan_buffers(scene, params, capacity, uint64_t{size.pixels} * size.blocks, options.adaptive, baked ? &*baked : nullptr);
  std::vector<vulkan::Binding> bindings;
  buffers.reserve(plan.size());
  for (BufferPlan& p : plan) {
    const Buffer* made = nullptr;
    if (p.bytes > 0) {
      Buffer& buffer = buffers.emplace_back(device, p.bytes, p.domain);
      if (p.data) buffer.upload(p.data, p.bytes);
      made = &buffer;
      if (p.bindings[0].number == gpu::kBindCounters) counters = &buffer;
      if (p.bindings[0].number == gpu::kBindFilm) film_block = &buffer;
      if (p.bindings[0].number == gpu::kBindAov) aov_block = &buffer;
      if (p.bindings[0].number == gpu::kBindPixelList) pixel_list = &buffer;
    }
    for (vulkan::Binding binding : p.bindings) {
      binding.buffer = made;
      bindings.push_back(binding);
    }
  }
  const std::vector<uint32_t> zeros(gpu::kCounterWords, 0);
  counters->upload(zeros.data(), zeros.size() * sizeof(uint32_t));
  statistics.upload_seconds = upload.seconds();
  statistics.device_bytes = device.allocated_bytes();

  Timer compile;
  table = std::make_unique<vulkan::BindingTable>(device, bindings, sizeof(WaveParams));
  kernels = build_kernels(device, *table, features, options, params.end_sample, baked ? &*baked : nullptr);
  warm_up();
  statistics.compile_seconds = compile.seconds();
  commands.set_timing(options.timing);
}

// Drivers compile a kernel when it is first dispatched: do that now, with nothing to do.
void Renderer::Impl::warm_up() {
  WaveParams wave{};
  wave.block_count = wave.pixel_count = 0;
  const auto touch = [&](const Kernels::Pointer& kernel) {
    if (kernel) commands.dispatch(*kernel, 1, &wave, sizeof(wave));
  };
  touch(kernels.init_from_camera);
  wave.mode = gpu::kPrepareTrace;
  touch(kernels.prepare_dispatch);
  touch(kernels.intersect_primary);
  touch(kernels.intersect_closest);
  touch(kernels.intersect_shadow);
  touch(kernels.sample_medium);
  touch(kernels.shade_segment);
  touch(kernels.shade_medium);
  touch(kernels.shade_emitter);
  touch(kernels.shade_escaped);
  for (const Kernels::Pointer& kernel : kernels.shade_surface) touch(kernel);
  touch(kernels.write_film);
  touch(kernels.write_aov);
  touch(kernels.write_moment);
  touch(kernels.follow_paths);
  commands.submit_and_wait();
}

// Number of bounces (rays of a path) that can still contribute.
uint64_t Renderer::Impl::last_bounce() const {
  // Null surfaces do not count: the queues tell when all paths have ended.
  if (features.shadow_null) return std::numeric_limits<uint32_t>::max();
  const bool lights_can_be_hit = features.area_lights() || features.environment();
  if (features.max_depth == std::numeric_limits<uint32_t>::max()) return features.max_depth;
  return lights_can_be_hit ? features.max_depth : std::max(features.max_depth, 1u) - 1;
}

// One lane a pixel and block.
void Renderer::Impl::dispatch_pixels(const Kernels::Pointer& kernel, const WaveParams& wave) {
  const uint32_t pixels = wave.pixel_count * wave.block_count;
  if (kernel)
    commands.dispatch(*kernel, (pixels + gpu::kWorkgroupSize - 1) / gpu::kWorkgroupSize, &wave, sizeof(wave));
}

void Renderer::Impl::record_bounce(WaveParams& wave) {
  const auto queue_dispatch = [&](const Kernels::Pointer& kernel, uint32_t dispatch) {
    if (kernel)
      commands.dispatch_indirect(*kernel, *counters, sizeof(uint32_t) * (gpu::kCounterArguments + 4 * dispatch),
                                 &wave, sizeof(wave));
  };
  const auto prepare = [&](uint32_t mode) {
    wave.mode = mode;
    commands.dispatch(*kernels.prepare_dispatch, 1, &wave, sizeof(wave));
  };
  queue_dispatch(wave.bounce == 0 ? kernels.intersect_primary : kernels.intersect_closest, gpu::kDispatchClosest);
  if (wave.bounce == 0) dispatch_pixels(kernels.write_aov, wave);
  if (kernels.shade_segment) {
    queue_dispatch(kernels.shade_segment, gpu::kDispatchQueue + wave.ray_queue);
    prepare(gpu::kPrepareShadow);
    queue_dispatch(kernels.intersect_shadow, gpu::kDispatchShadow);
  }
  queue_dispatch(kernels.sample_medium, gpu::kDispatchQueue + wave.ray_queue);
  prepare(gpu::kPrepareShade);
  queue_dispatch(kernels.shade_escaped, gpu::kDispatchQueue + gpu::kQueueEscaped);
  queue_dispatch(kernels.shade_emitter, gpu::kDispatchQueue + gpu::kQueueEmitter);
  for (uint32_t c = 0; c < kernels.shade_surface.size(); ++c)
    queue_dispatch(kernels.shade_surface[c], gpu::kDispatchQueue + gpu::kQueueSurface + c);
  queue_dispatch(kernels.shade_medium, gpu::kDispatchQueue + gpu::kQueueSurface + params.class_count);
  ++wave.bounce;
  wave.ray_queue = 1 - wave.ray_queue;
  prepare(gpu::kPrepareTrace);
  queue_dispatch(kernels.intersect_shadow, gpu::kDispatchShadow);
}

bool Renderer::Impl::render_wave(WaveParams wave, const std::function<bool()>& goes_on) {
  if (baked) {
    commands.dispatch(*kernels.follow_paths, (wave.pixel_count + gpu::kWorkgroupSize - 1) / gpu::kWorkgroupSize, &wave,
                      sizeof(wave));
    const Timer submission;
    commands.submit_and_wait();
    if (submission.seconds() > kLongestSubmission) pixels_per_wave = std::max(pixels_per_wave / 2, gpu::kWorkgroupSize);
    if (submission.seconds() < kLongestSubmission / 3) pixels_per_wave = std::min(2 * pixels_per_wave, size.pixels);
    take_counters();
    return true;
  }
  const uint32_t paths = wave.pixel_count * wave.block_count * kBlockSamples;
  const uint32_t groups = (paths + gpu::kWorkgroupSize - 1) / gpu::kWorkgroupSize;
  commands.fill(*counters, 0, 0, sizeof(uint32_t) * gpu::kCounterClosestTotal);
  commands.dispatch(*kernels.init_from_camera, groups, &wave, sizeof(wave));
  wave.bounce = wave.ray_queue = 0;
  wave.mode = gpu::kPrepareTrace;
  commands.dispatch(*kernels.prepare_dispatch, 1, &wave, sizeof(wave));
  const uint64_t end = last_bounce();
  while (wave.bounce < end) {
    const uint64_t until = std::min<uint64_t>(end, wave.bounce + bounces_per_submit);
    while (wave.bounce < until) record_bounce(wave);
    if (wave.bounce >= end) break;
    const Timer submission;
    commands.submit_and_wait();
    bounces_per_submit = submission.seconds() > kLongestSubmission ? std::max(bounces_per_submit / 2, 1u)
                                                                   : std::min(bounces_per_submit + 1, kBouncesPerSubmit);
    if (!goes_on()) return false;
    const auto* words = static_cast<const uint32_t*>(counters->mapped());
    if (words[gpu::kCounterQueue + wave.ray_queue] == 0) break;
  }
  dispatch_pixels(kernels.write_moment, wave);
  dispatch_pixels(kernels.write_film, wave);
  commands.submit_and_wait();
  take_counters();
  return true;
}

void Renderer::Impl::take_counters() {
  auto* words = static_cast<uint32_t*>(counters->mapped());
  statistics.closest_rays += words[gpu::kCounterClosestTotal];
  statistics.shadow_rays += words[gpu::kCounterShadowTotal];
  statistics.nonfinite += words[gpu::kCounterNonfinite];
  statistics.overflow += words[gpu::kCounterOverflow];
  const uint32_t unfinished = words[gpu::kCounterUnfinished];
  for (uint32_t w = gpu::kCounterClosestTotal; w <= gpu::kCounterUnfinished; ++w) words[w] = 0;
  if (unfinished > 0)
    throw RenderError(fmt::format("{} ended the loops of {} lanes before their rays were traced to the end: the scene "
                                  "has rays of too many steps, or paths of too many bounces, for this driver",
                                  device.info().driver, unfinished));
}

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
  PassSums sums(r.params, r.size.blocks, r.scene);
  const bool goes_on = r.add_passes(film, sums);
  if (goes_on && r.options.adaptive && film.has_variance()) r.add_where_noisy(film, sums);
  r.statistics.render_seconds = r.timer.seconds();
  r.statistics.kernels = r.commands.kernel_times();
  r.statistics.paths = r.paths_of(film) - r.begun_paths;
}

uint64_t Renderer::Impl::paths_of(const FilmBuffer& film) {
  return static_cast<uint64_t>(std::llround(film.mean_samples() * static_cast<double>(film.pixels())));
}

bool Renderer::Impl::report(const FilmBuffer& film, uint64_t pixel_samples_more) {
  const double pixels = static_cast<double>(film.pixels()), finished = film.mean_samples();
  const double samples = finished + static_cast<double>(pixel_samples_more) / pixels;
  progress.samples = static_cast<uint64_t>(finished);
  progress.seconds = timer.seconds();
  progress.fraction = samples / static_cast<double>(options.samples);
  progress.mpaths_per_s = (samples * pixels - static_cast<double>(begun_paths)) * 1e-6 / progress.seconds;
  return !options.progress || options.progress(progress);
}

bool Renderer::Impl::within_limits(const FilmBuffer& film) {
  if (options.time_limit > 0 && timer.seconds() >= options.time_limit) return false;
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
         ((options.time_limit > 0 && timer.seconds() >= options.time_limit / 4) ||
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
    wave.block_count = static_cast<uint32_t>(std::min<uint64_t>(size.blocks, end_block - block));
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
      wave.pixel_count = std::min(pixels_per_wave, all_pixels - pixel);
      list_pixels(wave);
      if (!render_wave(wave, [&] { return goes_on(pixel); })) return false;
      sums.take(wave, mapped_film(), mapped_aovs());
      stop = !goes_on(pixel + wave.pixel_count);
      if (stop && pixel + wave.pixel_count < all_pixels) return false;
    }

    // Add the pass to the film.
    for (uint32_t b = 0; b < wave.block_count; ++b) {
      const uint64_t first = (block + b) * kBlockSamples, n = std::min<uint64_t>(kBlockSamples, end_sample - first);
      sums.add_block_to(film, b, n);
      film.finish_blocks({first, n});
    }
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
  if (options.time_limit > 0) factor = std::min(factor, options.time_limit / timer.seconds());
  return samples * std::max(factor, 1.05);
}

void Renderer::Impl::list_pixels(const WaveParams& wave) {
  if (!pixel_list) return;
  std::vector<glm::uvec2> listed(wave.pixel_count);
  for (uint32_t i = 0; i < wave.pixel_count; ++i) listed[i] = {wave.first_pixel + i, wave.first_block};
  pixel_list->upload(listed.data(), listed.size() * sizeof(listed[0]));
}

void Renderer::Impl::add_where_noisy(FilmBuffer& film, const PassSums& sums) {
  if (film.sampling_density().empty()) film.set_sampling_density(sampling_density(film));
  const auto first_block = static_cast<uint32_t>(options.first_sample / kBlockSamples);
  const auto most = static_cast<double>(options.samples);
  // Many blocks a lane even out the lengths of paths, few follow the density.
  const uint64_t few = baked ? std::min<uint64_t>(film.blocks() / 2, size.blocks) : 1;
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
      const size_t rows = size_t{pixels_per_wave} * size.blocks / chunk;
      wave.pixel_count = static_cast<uint32_t>(std::min(rows, listed.size() - first));
      const std::span<const glm::uvec2> of_wave = std::span(listed).subspan(first, wave.pixel_count);
      pixel_list->upload(of_wave.data(), of_wave.size_bytes());
      if (!render_wave(wave, [&] { return report(film, 0); })) return;
      sums.add_listed_to(film, wave, of_wave, mapped_film(), mapped_aovs());
      if (!report(film, 0)) return;
      if (options.time_limit > 0 && timer.seconds() >= options.time_limit) return;
    }
    if (!within_limits(film)) return;
  }
}

const RenderStatistics& Renderer::statistics() const { return impl_->statistics; }
std::vector<std::string> Renderer::stages_run() const { return impl_->kernels.run; }
std::vector<std::string> Renderer::stages_skipped() const { return impl_->kernels.skipped; }

MemoryPlan Renderer::plan_memory(const vulkan::DeviceInfo& device, const PackedScene& scene,
                                 const RenderOptions& options) {
  MemoryPlan plan;
  const std::optional<BakedGeometry> baked = choose_baked(scene, options);
  const uint32_t capacity = capacity_for(scene.params, options);
  const WaveSize size = wave_size(scene.params, options, capacity, baked.has_value());
  for (const BufferPlan& p : plan_buffers(scene, scene.params, capacity, uint64_t{size.pixels} * size.blocks,
                                          options.adaptive, baked ? &*baked : nullptr)) {
    uint64_t limit = std::numeric_limits<uint64_t>::max();
    for (const vulkan::Binding& b : p.bindings) limit = std::min(limit, vulkan::largest_buffer(device, b));
    if (p.bytes > 0) plan.buffers.push_back({p.name, p.bytes, limit});
  }
  return plan;
}

}  // namespace tachylite
