#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pack/bake_geometry.h"
#include "pack/feature_set.h"
#include "vulkan/kernel.h"
#include "wavefront/renderer.h"

namespace tachylite {

/// The pipelines that a scene needs; those it does not need are null.
struct Kernels {
  using Pointer = std::unique_ptr<vulkan::Kernel>;
  Pointer init_from_camera, prepare_dispatch, intersect_primary, intersect_closest, intersect_shadow, shade_escaped,
      shade_emitter, sample_medium, shade_medium, shade_segment, write_film, write_aov, write_moment, follow_paths;
  std::vector<Pointer> shade_surface;  // one a material class; null for classes that need no shading

  std::vector<std::string> run, skipped;  // stages, for people
};

/// Which of several tracers that work side by side.
struct TracerPlace {
  uint32_t index = 0, count = 1;
};

/// What kernels are made of. All samples of a pixel lie below `end_sample`. made: is told of each as soon as it is there, by one
/// thread at a time. place: tracers side by side compile kernels in different orders, so that each finds what
/// others have compiled in the driver's cache on disk.
struct KernelSource {
  vulkan::Device& device;
  const vulkan::BindingTable& table;
  const FeatureSet& features;
  const RenderOptions& options;
  uint64_t end_sample;
  bool reads_storage;
  TracerPlace place;
  std::function<void(const vulkan::Kernel&)> made;
};

/// The one kernel for whole paths.
Kernels build_fused_kernel(const KernelSource& source, const BakedGeometry& baked);
/// The stages; may_guide: but those of surfaces that can_be_guided(), for build_surface_kernels().
Kernels build_stages(const KernelSource& source, const BakedGeometry& walls, bool may_guide);
/// The stages that build_stages() has left out.
void build_surface_kernels(const KernelSource& source, bool guided, Kernels& kernels);

/// What traces photons, beside stages that it shares with paths.
struct PhotonKernels {
  Kernels::Pointer init_from_lights;
  std::vector<Kernels::Pointer> scatter_photons;  // shade_surface for photons; null for classes that are not guided
  std::vector<std::string> names;
};
/// Of scenes that may_be_guided().
PhotonKernels build_photon_kernels(const KernelSource& source);

}  // namespace tachylite
