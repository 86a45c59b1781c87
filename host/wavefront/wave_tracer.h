#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "pack/bake_geometry.h"
#include "pack/pack_scene.h"
#include "shared/sampler.h"
#include "vulkan/buffer.h"
#include "vulkan/commands.h"
#include "wavefront/kernels.h"
#include "wavefront/renderer.h"

namespace tachylite {

constexpr uint64_t kMostSamples = uint64_t{1} << gpu::kMaxSampleBits;  // of a pixel

/// What is decided about a render before anything is allocated.
struct WavePlan {
  WavePlan(const PackedScene& scene, const RenderOptions& options);

  std::optional<BakedGeometry> baked;  // one kernel for whole paths
  BakedGeometry walls;                 // else: what is not in the tree
  bool may_guide = false;              // photons decide whether directions are guided
  uint32_t capacity = 0;               // paths in flight, in stages
  uint32_t pixels = 0, blocks = 0;     // of a wave at most: `blocks` blocks of samples of `pixels` pixels in tile order
};

/// The pixels of a wave that are not listed, as a list.
std::vector<glm::uvec2> consecutive_pixels(const gpu::WaveParams& wave);

/// Traces waves of paths (shared/render_params.h): the scene's buffers on the device, its kernels, and the loop over
/// bounces. `scene` and `options` must outlive it.
class WaveTracer {
 public:
  /// Before the first wave build_surface_kernels() must be called.
  WaveTracer(vulkan::Device& device, const PackedScene& scene, const RenderOptions& options, TracerPlace place);

  /// Where photons decide whether directions are guided: traces its part of them. Then one tracer adds those of all
  /// others to its own, learns the guide, or nothing where it would not pay (false), and the others copy it.
  bool may_guide() const { return plan_.may_guide; }
  void trace_photons();
  void add_photons(const WaveTracer& other);
  bool learn_guide();
  void copy_guide(const WaveTracer& other);
  /// The kernels that wait for the photons' word.
  void build_surface_kernels(bool guided);

  const gpu::RenderParams& params() const { return params_; }
  /// Pixels of the next wave at most: no submission is to take long.
  uint32_t pixels_per_wave() const { return pixels_per_wave_; }
  uint32_t most_blocks() const { return plan_.blocks; }
  bool follows_whole_paths() const { return plan_.baked.has_value(); }
  /// Adaptive sampling: the pixels of the next wave, each in tile order, and its first block.
  void list_pixels(std::span<const glm::uvec2> listed);
  /// False where `goes_on`, which is asked now and then, said so: the wave is abandoned. Else film() and aovs() hold
  /// its sums. Adds rays, contributions that are not finite and overflows to the statistics. Throws RenderError where the
  /// driver has ended loops too early.
  bool trace(gpu::WaveParams wave, const std::function<bool()>& goes_on, RenderStatistics& statistics);

  const glm::vec4* film() const { return static_cast<const glm::vec4*>(film_block_->mapped()); }
  const glm::vec4* aovs() const {  // or null
    return aov_block_ ? static_cast<const glm::vec4*>(aov_block_->mapped()) : nullptr;
  }
  const Kernels& kernels() const { return kernels_; }
  const std::map<std::string, vulkan::KernelTime>& kernel_times() const { return commands_.kernel_times(); }
  double upload_seconds() const { return upload_seconds_; }
  double photon_seconds() const { return photon_seconds_; }
  double compile_seconds() const { return compile_seconds_; }

 private:
  void upload(const RenderOptions& options);
  void touch(const vulkan::Kernel& kernel);
  KernelSource kernel_source();
  void dispatch_queue(const Kernels::Pointer& kernel, uint32_t dispatch, const gpu::WaveParams& wave);
  void dispatch_lanes(const Kernels::Pointer& kernel, uint32_t lanes, const gpu::WaveParams& wave);
  void prepare(uint32_t mode, gpu::WaveParams& wave);
  void begin_paths(const Kernels::Pointer& init, gpu::WaveParams& wave);
  void record_bounce(gpu::WaveParams& wave);
  uint64_t last_bounce() const;
  void take_counters(RenderStatistics& statistics);

  vulkan::Device& device_;
  const PackedScene& scene_;
  const FeatureSet& features_;
  const RenderOptions& options_;
  TracerPlace place_;
  WavePlan plan_;
  gpu::RenderParams params_;
  uint32_t bounces_per_submit_;
  uint32_t pixels_per_wave_;
  std::vector<vulkan::Buffer> buffers_;
  vulkan::Buffer* counters_ = nullptr;
  vulkan::Buffer* film_block_ = nullptr;
  vulkan::Buffer* aov_block_ = nullptr;   // null: no auxiliary channels
  vulkan::Buffer* pixel_list_ = nullptr;  // null: pixels are not listed
  vulkan::Buffer* photons_ = nullptr;     // null: directions are never guided
  vulkan::Buffer* guide_ = nullptr;
  std::unique_ptr<vulkan::BindingTable> table_;
  Kernels kernels_;
  vulkan::Commands commands_;
  uint32_t caustics_ = 0;  // kCounterCaustics after the photons
  double upload_seconds_ = 0, photon_seconds_ = 0, compile_seconds_ = 0;
};

}  // namespace tachylite
