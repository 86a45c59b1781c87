#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "image/film.h"
#include "pack/pack_scene.h"
#include "vulkan/commands.h"
#include "vulkan/device_pool.h"

namespace tachylite {

enum class SamplerKind { kSobol, kIndependent };

/// How kernels are put together. kStages: a kernel a stage, with queues and a tree. kFused: one kernel follows whole
/// paths through geometry that is compiled into it; tiny scenes only. kAuto: kFused where the scene fits.
enum class KernelStructure { kAuto, kStages, kFused };

/// Whether photons, traced before the render, guide paths on diffuse surfaces to the light that comes by way of glass
/// and metal (shaders/path/guide.glsl). kAuto: where they find that this pays.
enum class Guiding { kAuto, kOn, kOff };

struct RenderProgress {
  uint64_t samples = 0, target_samples = 0;  // per pixel, on average
  double fraction = 0;                       // of all paths, finer than samples
  double seconds = 0, mpaths_per_s = 0;
  double relative_error = 0;                 // FilmBuffer::relative_error(), 0 while unknown
};

struct RenderOptions {
  uint64_t samples = 16;        // per pixel
  uint64_t first_sample = 0;    // multiple of kBlockSamples
  uint32_t seed = 0;
  SamplerKind sampler = SamplerKind::kSobol;
  uint32_t max_paths = 0;       // in flight, in stages, on all devices; 0: as many as keep them busy
  KernelStructure structure = KernelStructure::kAuto;
  Guiding guiding = Guiding::kAuto;  // kOn is ignored where may_be_guided() is false
  double time_limit = 0;        // seconds of rendering; 0: none. At least one block is rendered.
  double error_limit = 0;       // FilmBuffer::relative_error() to reach; 0: none
  /// More samples where the image is noisier (wavefront/adaptive_sampling.h): `samples` are their mean.
  bool adaptive = false;
  bool timing = false;          // timestamp queries around each kernel
  /// Called now and then, also within a pass over the image, by one thread at a time; returning false stops with the
  /// passes that are finished.
  std::function<bool(const RenderProgress&)> progress;
};

/// Device time and counts of a render. Several devices: the seconds of kernels are the mean of theirs.
struct RenderStatistics {
  uint64_t paths = 0, closest_rays = 0, shadow_rays = 0, nonfinite = 0, overflow = 0;
  double upload_seconds = 0, compile_seconds = 0, render_seconds = 0;
  uint64_t device_bytes = 0;
  std::map<std::string, vulkan::KernelTime> kernels;
};

/// What a renderer would allocate, known before anything is allocated.
struct MemoryPlan {
  struct Entry {
    std::string name;
    uint64_t bytes = 0, limit = 0;  // limit of one buffer of its kind on the device
  };
  std::vector<Entry> buffers;
  uint64_t total() const;
};

/// Devices that pay for a render: more than one where `device` is Mesa's llvmpipe, which works more evenly then
/// (vulkan/device_pool.h), the scene is rendered in stages, and the render is so long that compiling all kernels once
/// more is little.
uint32_t count_devices(const vulkan::DeviceInfo& device, const PackedScene& scene, const RenderOptions& options);

/// The wavefront path tracer: pipelines for the scene's FeatureSet, its buffers, and the loop of kernels.
class Renderer {
 public:
  /// Uploads, builds the pipelines and, where that may pay, traces photons. `scene` must outlive this. Throws RenderError
  /// naming needed and available bytes when it cannot fit, and InputError where kFused is asked for and the scene does
  /// not fit.
  Renderer(vulkan::Device& device, const PackedScene& scene, const RenderOptions& options);
  /// Renders on several devices, alike, at the same time: each holds the scene and takes waves of paths. The image is
  /// the same, bit for bit.
  Renderer(vulkan::DevicePool::Devices devices, const PackedScene& scene, const RenderOptions& options);
  ~Renderer();

  /// Adds to the film, which holds the samples [first_sample, first_sample + n) or none, until samples, time, error or
  /// the caller say stop. After an exception it holds the passes before: another renderer may go on with it. The image
  /// does not depend on max_paths.
  void render_into(FilmBuffer& film);
  static FilmBuffer new_film(const PackedScene& scene);
  FilmBuffer render() {
    FilmBuffer film = new_film(scene_);
    render_into(film);
    return film;
  }

  const RenderStatistics& statistics() const;
  /// Stages that run for this scene, and those that it does not need.
  std::vector<std::string> stages_run() const, stages_skipped() const;

  /// Of each of so many devices.
  static MemoryPlan plan_memory(const vulkan::DeviceInfo& device, const PackedScene& scene,
                                const RenderOptions& options, uint32_t devices = 1);

 private:
  struct Impl;
  void make(std::span<vulkan::Device* const> devices, const RenderOptions& options);

  const PackedScene& scene_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tachylite
