#include "wavefront/wave_tracer.h"

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "base/timer.h"
#include "shared/bindings.h"
#include "shared/counters.h"
#include "shared/path_state.h"
#include "wavefront/adaptive_sampling.h"
#include "wavefront/pass_sums.h"
#include "wavefront/photon_guide.h"
#include "wavefront/scene_buffers.h"

namespace tachylite {
namespace {

using gpu::kBlockSamples;
using gpu::WaveParams;
using vulkan::Buffer;

constexpr uint32_t kFusedPaths = 1u << 24;  // at most, of one dispatch that follows whole paths
constexpr uint32_t kFirstFusedPaths = 1u << 20;  // of the first: less than a second on one slow core
constexpr uint32_t kFusedBlocks = 8;
constexpr uint32_t kBouncesPerSubmit = 16;  // between two looks at the queue's length; fewer where they take longer
constexpr double kLongestSubmission = 0.3;  // seconds

// Paths in flight: whole tiles of whole blocks, no more than the render has, or its `photons`.
uint32_t capacity_for(const gpu::RenderParams& params, const RenderOptions& options, uint64_t photons) {
  const uint64_t blocks = (options.samples + kBlockSamples - 1) / kBlockSamples;
  const uint64_t all = std::max(uint64_t{params.tile_count} * kTilePixels * kBlockSamples * blocks, photons);
  const uint64_t step = kTilePixels * kBlockSamples;
  const uint64_t wanted = std::min<uint64_t>(std::max<uint64_t>(options.max_paths, step), all);
  return static_cast<uint32_t>(wanted / step * step);
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
    throw InputError("the scene does not fit into one kernel: it is too large, or has materials or textures that need "
                     "stages");
  return baked;
}

}  // namespace

std::vector<glm::uvec2> consecutive_pixels(const WaveParams& wave) {
  std::vector<glm::uvec2> listed(wave.pixel_count);
  for (uint32_t i = 0; i < wave.pixel_count; ++i) listed[i] = {wave.first_pixel + i, wave.first_block};
  return listed;
}

WavePlan::WavePlan(const PackedScene& scene, const RenderOptions& options)
    : baked(choose_baked(scene, options)), may_guide(!baked && may_be_guided(scene, options.guiding)) {
  if (!baked) walls = bake_walls(scene);
  capacity = capacity_for(scene.params, options, may_guide ? photon_count(scene.params) : 0);
  const uint32_t all_pixels = scene.params.tile_count * kTilePixels;
  if (baked) {
    // A lane renders all blocks of its pixel: many even out the lengths of paths.
    const uint64_t all_blocks = (options.samples + kBlockSamples - 1) / kBlockSamples;
    pixels = std::min(all_pixels, kFusedPaths / kBlockSamples);
    blocks = static_cast<uint32_t>(
        std::min<uint64_t>({all_blocks, kFusedBlocks, std::max(1u, kFusedPaths / (pixels * kBlockSamples))}));
    return;
  }
  pixels = std::min(all_pixels, capacity / kBlockSamples);
  blocks = std::max(1u, capacity / (pixels * kBlockSamples));
}

WaveTracer::WaveTracer(vulkan::Device& device, const PackedScene& scene, const RenderOptions& options,
                       TracerPlace place)
    : device_(device), scene_(scene), features_(scene.features), options_(options), place_(place), plan_(scene, options),
      params_(scene.params), bounces_per_submit_(kBouncesPerSubmit), pixels_per_wave_(plan_.pixels), commands_(device) {
  if (plan_.baked) pixels_per_wave_ = std::min(plan_.pixels, kFirstFusedPaths / (plan_.blocks * kBlockSamples));
  params_.capacity = plan_.capacity;
  params_.seed = options.seed;
  params_.end_sample = static_cast<uint32_t>(end_of_samples(options));
  params_.aov_stride = plan_.pixels * plan_.blocks;
  params_.light_count = static_cast<uint32_t>(scene.emission.size());
  params_.guide_scale = guide_scale(params_);
  const Timer upload_timer;
  upload(options);
  upload_seconds_ = upload_timer.seconds();

  const Timer compile_timer;
  kernels_ = plan_.baked ? build_fused_kernel(kernel_source(), *plan_.baked)
                         : build_stages(kernel_source(), plan_.walls, plan_.may_guide);
  compile_seconds_ = compile_timer.seconds();
}

// Drivers compile a kernel when it is first dispatched: that goes on while the next is made.
KernelSource WaveTracer::kernel_source() {
  const auto made = [this](const vulkan::Kernel& kernel) { touch(kernel); };
  return {device_, *table_, features_, options_, params_.end_sample, reads_storage(device_.info(), scene_), place_, made};
}

void WaveTracer::build_surface_kernels(bool guided) {
  const Timer timer;
  if (plan_.may_guide) {
    if (!guided) kernels_.skipped.push_back("guide");
    tachylite::build_surface_kernels(kernel_source(), guided, kernels_);
  }
  commands_.submit_and_wait();
  commands_.set_timing(options_.timing);
  compile_seconds_ += timer.seconds();
}

void WaveTracer::upload(const RenderOptions& options) {
  std::vector<BufferPlan> plan = plan_buffers(device_.info(), scene_, params_, plan_, options.adaptive);
  std::vector<vulkan::Binding> bindings;
  buffers_.reserve(plan.size());
  for (BufferPlan& p : plan) {
    const Buffer* made = nullptr;
    if (p.bytes > 0) {
      const bool shared = p.pages && device_.imports_host_memory();
      Buffer& buffer = buffers_.emplace_back(shared ? Buffer::over(device_, p.data, p.bytes)
                                                    : Buffer(device_, p.bytes, p.domain));
      if (p.data && !shared) buffer.upload(p.data, p.bytes);
      made = &buffer;
      if (p.bindings[0].number == gpu::kBindCounters) counters_ = &buffer;
      if (p.bindings[0].number == gpu::kBindFilm) film_block_ = &buffer;
      if (p.bindings[0].number == gpu::kBindAov) aov_block_ = &buffer;
      if (p.bindings[0].number == gpu::kBindPixelList) pixel_list_ = &buffer;
      if (p.bindings[0].number == gpu::kBindPhotons) photons_ = &buffer;
      if (p.bindings[0].number == gpu::kBindGuide) guide_ = &buffer;
    }
    for (vulkan::Binding binding : p.bindings) {
      binding.buffer = made;
      bindings.push_back(binding);
    }
  }
  const std::vector<uint32_t> zeros(gpu::kCounterWords, 0);
  counters_->upload(zeros.data(), zeros.size() * sizeof(uint32_t));
  table_ = std::make_unique<vulkan::BindingTable>(device_, bindings, sizeof(WaveParams));
}

// Runs a kernel where it has nothing to do.
void WaveTracer::touch(const vulkan::Kernel& kernel) {
  const WaveParams wave{};
  commands_.dispatch(kernel, 1, &wave, sizeof(wave));
  commands_.submit();
}

// Number of bounces (rays of a path) that can still contribute; auxiliary channels take the first one.
uint64_t WaveTracer::last_bounce() const {
  // Null surfaces do not count: the queues tell when all paths have ended.
  if (features_.shadow_null) return std::numeric_limits<uint32_t>::max();
  const bool lights_can_be_hit = features_.area_lights() || features_.environment();
  if (features_.max_depth == std::numeric_limits<uint32_t>::max()) return features_.max_depth;
  const uint32_t bounces = lights_can_be_hit ? features_.max_depth : std::max(features_.max_depth, 1u) - 1;
  return kernels_.write_aov ? std::max(bounces, 1u) : bounces;
}

// One lane an entry of a queue.
void WaveTracer::dispatch_queue(const Kernels::Pointer& kernel, uint32_t dispatch, const WaveParams& wave) {
  if (kernel)
    commands_.dispatch_indirect(*kernel, *counters_, sizeof(uint32_t) * (gpu::kCounterArguments + 4 * dispatch), &wave,
                                sizeof(wave));
}

void WaveTracer::dispatch_lanes(const Kernels::Pointer& kernel, uint32_t lanes, const WaveParams& wave) {
  if (kernel)
    commands_.dispatch(*kernel, (lanes + gpu::kWorkgroupSize - 1) / gpu::kWorkgroupSize, &wave, sizeof(wave));
}

void WaveTracer::prepare(uint32_t mode, WaveParams& wave) {
  wave.mode = mode;
  commands_.dispatch(*kernels_.prepare_dispatch, 1, &wave, sizeof(wave));
}

void WaveTracer::begin_paths(const Kernels::Pointer& init, WaveParams& wave) {
  commands_.fill(*counters_, 0, 0, sizeof(uint32_t) * gpu::kCounterClosestTotal);
  dispatch_lanes(init, wave.pixel_count * wave.block_count * kBlockSamples, wave);
  wave.bounce = wave.ray_queue = 0;
  prepare(gpu::kPrepareFirst, wave);
}

void WaveTracer::record_bounce(WaveParams& wave) {
  const Kernels& k = kernels_;
  dispatch_queue(wave.bounce == 0 ? k.intersect_primary : k.intersect_closest, gpu::kDispatchClosest, wave);
  if (wave.bounce == 0) dispatch_lanes(k.write_aov, wave.pixel_count * wave.block_count, wave);
  if (k.shade_segment) {
    dispatch_queue(k.shade_segment, gpu::kDispatchClosest, wave);
    prepare(gpu::kPrepareShadow, wave);
    dispatch_queue(k.intersect_shadow, gpu::kDispatchShadow, wave);
  }
  dispatch_queue(k.sample_medium, gpu::kDispatchQueue + wave.ray_queue, wave);
  prepare(gpu::kPrepareShade, wave);
  dispatch_queue(k.shade_escaped, gpu::kDispatchQueue + gpu::kQueueEscaped, wave);
  dispatch_queue(k.shade_emitter, gpu::kDispatchQueue + gpu::kQueueEmitter, wave);
  for (uint32_t c = 0; c < k.shade_surface.size(); ++c)
    dispatch_queue(k.shade_surface[c], gpu::kDispatchQueue + gpu::kQueueSurface + c, wave);
  dispatch_queue(k.shade_medium, gpu::kDispatchQueue + gpu::kQueueSurface + params_.class_count, wave);
  ++wave.bounce;
  wave.ray_queue = 1 - wave.ray_queue;
  dispatch_queue(k.intersect_shadow, gpu::kDispatchShadow, wave);
}

void WaveTracer::trace_photons() {
  const Timer compile_timer;
  const PhotonKernels photon_kernels = build_photon_kernels(kernel_source());
  kernels_.run.insert(kernels_.run.end(), photon_kernels.names.begin(), photon_kernels.names.end());
  // On surfaces that are not guided photons scatter as paths do; their shadow rays are not traced.
  const auto scatter = [&](size_t c) -> const Kernels::Pointer& {
    return photon_kernels.scatter_photons[c] ? photon_kernels.scatter_photons[c] : kernels_.shade_surface[c];
  };
  const size_t classes = kernels_.shade_surface.size();
  commands_.submit_and_wait();
  compile_seconds_ += compile_timer.seconds();

  const Timer timer;
  commands_.set_timing(options_.timing);
  commands_.fill(*photons_, 0);
  WaveParams wave{};
  wave.photons = 1;
  wave.block_count = 1;
  const uint64_t all = photon_count(params_) / kBlockSamples;  // as samples of so many pixels
  const auto begin_of = [&](uint32_t p) { return static_cast<uint32_t>(all * p / place_.count); };
  const uint32_t end_pixel = begin_of(place_.index + 1);
  for (wave.first_pixel = begin_of(place_.index); wave.first_pixel < end_pixel; wave.first_pixel += wave.pixel_count) {
    wave.pixel_count = std::min(plan_.capacity / kBlockSamples, end_pixel - wave.first_pixel);
    if (pixel_list_) list_pixels(consecutive_pixels(wave));
    begin_paths(photon_kernels.init_from_lights, wave);
    for (const uint64_t end = std::min<uint64_t>(last_bounce(), kPhotonBounces); wave.bounce < end;) {
      dispatch_queue(kernels_.intersect_closest, gpu::kDispatchClosest, wave);
      prepare(gpu::kPrepareShade, wave);
      for (size_t c = 0; c < classes; ++c)
        dispatch_queue(scatter(c), gpu::kDispatchQueue + gpu::kQueueSurface + static_cast<uint32_t>(c), wave);
      ++wave.bounce;
      wave.ray_queue = 1 - wave.ray_queue;
    }
    commands_.submit_and_wait();
  }
  commands_.set_timing(false);
  caustics_ = static_cast<const uint32_t*>(counters_->mapped())[gpu::kCounterCaustics];
  photon_seconds_ = timer.seconds();
}

void WaveTracer::add_photons(const WaveTracer& other) {
  std::vector<uint32_t> sum = photons_->download_all<uint32_t>();
  other.photons_->read_all<uint32_t>([&](std::span<const uint32_t> more) {
    std::transform(sum.begin(), sum.end(), more.begin(), sum.begin(), std::plus());
  });
  photons_->upload(sum.data(), sum.size() * sizeof(uint32_t));
  caustics_ += other.caustics_;
}

bool WaveTracer::learn_guide() {
  return photons_->read_all<uint32_t>([&](std::span<const uint32_t> flux) {
    if (options_.guiding != Guiding::kOn && !guide_pays(flux, caustics_)) return false;
    guide_->write_all<glm::uvec2>([&](std::span<glm::uvec2> guide) { build_guide(flux, features_.focusers, guide); });
    return true;
  });
}

void WaveTracer::copy_guide(const WaveTracer& other) {
  other.guide_->read_all<glm::uvec2>(
      [&](std::span<const glm::uvec2> guide) { guide_->upload(guide.data(), guide.size_bytes()); });
}

void WaveTracer::list_pixels(std::span<const glm::uvec2> listed) {
  pixel_list_->upload(listed.data(), listed.size_bytes());
}

bool WaveTracer::trace(WaveParams wave, const std::function<bool()>& goes_on, RenderStatistics& statistics) {
  if (plan_.baked) {
    dispatch_lanes(kernels_.follow_paths, wave.pixel_count, wave);
    const Timer submission;
    commands_.submit_and_wait();
    if (submission.seconds() > kLongestSubmission)
      pixels_per_wave_ = std::max(pixels_per_wave_ / 2, gpu::kWorkgroupSize);
    if (submission.seconds() < kLongestSubmission / 3) pixels_per_wave_ = std::min(2 * pixels_per_wave_, plan_.pixels);
    take_counters(statistics);
    return true;
  }
  begin_paths(kernels_.init_from_camera, wave);
  const uint64_t end = last_bounce();
  while (wave.bounce < end) {
    const uint64_t until = std::min<uint64_t>(end, wave.bounce + bounces_per_submit_);
    while (wave.bounce < until) record_bounce(wave);
    if (wave.bounce >= end) break;
    const Timer submission;
    commands_.submit_and_wait();
    const bool long_one = submission.seconds() > kLongestSubmission;
    bounces_per_submit_ = long_one ? std::max(bounces_per_submit_ / 2, 1u)
                                   : std::min(bounces_per_submit_ + 1, kBouncesPerSubmit);
    if (!goes_on()) return false;
    const auto* words = static_cast<const uint32_t*>(counters_->mapped());
    if (words[gpu::kCounterQueue + wave.ray_queue] == 0) break;
  }
  dispatch_lanes(kernels_.write_moment, wave.pixel_count * wave.block_count, wave);
  dispatch_lanes(kernels_.write_film, wave.pixel_count * wave.block_count, wave);
  commands_.submit_and_wait();
  take_counters(statistics);
  return true;
}

void WaveTracer::take_counters(RenderStatistics& statistics) {
  auto* words = static_cast<uint32_t*>(counters_->mapped());
  statistics.closest_rays += words[gpu::kCounterClosestTotal];
  statistics.shadow_rays += words[gpu::kCounterShadowTotal];
  statistics.nonfinite += words[gpu::kCounterNonfinite];
  statistics.overflow += words[gpu::kCounterOverflow];
  const uint32_t unfinished = words[gpu::kCounterUnfinished];
  for (uint32_t w = gpu::kCounterClosestTotal; w <= gpu::kCounterUnfinished; ++w) words[w] = 0;
  if (unfinished > 0)
    throw RenderError(fmt::format("{} ended the loops of {} lanes before their rays were traced to the end: the scene "
                                  "has rays of too many steps, or paths of too many bounces, for this driver",
                                  device_.info().driver, unfinished));
}

}  // namespace tachylite
