#include "wavefront/kernels.h"

#include <bit>
#include <mutex>

#include "base/parallel.h"
#include "kernel_spirv.h"
#include "pack/pack_material.h"
#include "shared/aov.h"
#include "shared/material.h"
#include "shared/medium.h"
#include "wavefront/photon_guide.h"

namespace tachylite {
namespace {

using vulkan::SpecializationConstants;

// Names of the leaf types of a class, for its kernel's name.
std::string class_name(const MaterialClass& c) {
  static constexpr const char* kNames[] = {"null",       "diffuse",       "roughdiffuse", "conductor",
                                           "roughconductor", "dielectric", "thindielectric", "roughdielectric",
                                           "plastic",    "roughplastic",  "principled",   "principledthin",
                                           "blinnphong", "microfacet"};
  std::string name;
  for (uint32_t type = 0; type < std::size(kNames); ++type)
    if ((c.bsdfs >> type) & 1u) name.append(name.empty() ? "" : "+").append(kNames[type]);
  if (c.flags & gpu::kMaterialTextured) name += " textured";
  if (c.flags & gpu::kMaterialHasFrames) name += " bumped";
  return name;
}

std::string surface_kernel_name(const MaterialClass& c) { return "shade_surface<" + class_name(c) + ">"; }

// Of a kernel that has a variant with wide rows (shaders/base/rows.glsl).
std::string row_kernel_file(const std::string& kernel, const KernelSource& source) {
  return kernel + (source.device.info().int64 ? "_wide" : "");
}
// The same of a kernel that gains by them only where it reads so: it reads much and stores little.
std::string trace_kernel_file(const std::string& kernel, const KernelSource& source) {
  return kernel + (source.reads_storage ? "_wide" : "");
}
std::string surface_kernel_file(const MaterialClass& c, const KernelSource& source) {
  const bool has_variant = source.device.info().int64 || can_be_guided(c);
  return row_kernel_file("shade_surface", source) + (has_variant ? bsdf_kernel_variant(c) : "");
}

// With what does not depend on the scene.
SpecializationConstants of_render(SpecializationConstants constants, const KernelSource& source) {
  constants[gpu::kFeatureSampler] =
      source.options.sampler == SamplerKind::kIndependent ? gpu::kSamplerIndependent : gpu::kSamplerSobol;
  constants[gpu::kFeatureLog2Samples] = static_cast<uint32_t>(std::bit_width(source.end_sample - 1));
  constants[gpu::kFeaturePixelList] = source.options.adaptive;
  constants[gpu::kFeatureStorageReads] = source.reads_storage;
  return constants;
}

// Which of `count` kernels a tracer makes i-th. One of two goes upwards and the other downwards, and they meet where each
// has compiled as much; of more, each two share a part of the kernels, before they come to those of others.
size_t nth_kernel(size_t i, size_t count, const TracerPlace& place) {
  const size_t pair = place.index / 2, pairs = (place.count + 1) / 2;
  if (place.index % 2 == 0) return (count * pair / pairs + i) % count;
  return (count * (pair + 1) / pairs + count - 1 - i) % count;
}

/// Makes kernels on all threads: drivers do half of the work of compiling a pipeline when it is made.
class KernelBuilder {
 public:
  /// names: gets those of the kernels.
  KernelBuilder(const KernelSource& source, std::vector<std::string>& names) : source_(source), names_(names) {}

  /// `kernel` is there after build().
  void add(Kernels::Pointer& kernel, const std::string& name, const std::string& file,
           SpecializationConstants constants) {
    names_.push_back(name);
    wanted_.push_back({&kernel, name, kernel_spirv(file), of_render(std::move(constants), source_)});
  }

  void build() {
    const size_t count = wanted_.size();
    const auto kernel = [&](size_t i) -> const Wanted& { return wanted_[nth_kernel(i, count, source_.place)]; };
    std::mutex telling;
    std::vector<bool> there(count);
    size_t told = 0;      // in the order of nth_kernel(): drivers compile them in that
    bool failed = false;  // no more may be told once telling has thrown
    const auto make = [&](size_t i) {
      const Wanted& w = kernel(i);
      *w.kernel = std::make_unique<vulkan::Kernel>(source_.device, source_.table, w.name, w.spirv, w.constants);
      const std::lock_guard lock(telling);
      there[i] = true;
      if (failed) return;
      failed = true;
      for (; told < count && there[told]; ++told) source_.made(**kernel(told).kernel);
      failed = false;
    };
    try {
      parallel_for_each(wanted_.size(), make);
    } catch (...) {
      vkQueueWaitIdle(source_.device.queue());  // may run kernels that are about to be destroyed
      throw;
    }
  }

 private:
  struct Wanted {
    Kernels::Pointer* kernel;
    std::string name;
    std::span<const uint32_t> spirv;
    SpecializationConstants constants;
  };
  const KernelSource& source_;
  std::vector<std::string>& names_;
  std::vector<Wanted> wanted_;
};

}  // namespace

Kernels build_fused_kernel(const KernelSource& source, const BakedGeometry& baked) {
  Kernels kernels;
  SpecializationConstants constants = source.features.union_constants();
  constants.insert(baked.constants.begin(), baked.constants.end());
  KernelBuilder builder(source, kernels.run);
  builder.add(kernels.follow_paths, "follow_paths", baked.kernel, constants);
  builder.build();
  kernels.skipped = {"tree", "path state and queues", "intersect_closest", "intersect_shadow", "shade_surface"};
  return kernels;
}

PhotonKernels build_photon_kernels(const KernelSource& source) {
  PhotonKernels kernels;
  const FeatureSet& features = source.features;
  KernelBuilder builder(source, kernels.names);
  builder.add(kernels.init_from_lights, "init_from_lights", row_kernel_file("init_from_lights", source),
              features.constants());
  kernels.scatter_photons.resize(features.classes.size());
  for (size_t c = 0; c < features.classes.size(); ++c) {
    const MaterialClass& material_class = features.classes[c];
    if (!can_be_guided(material_class)) continue;
    SpecializationConstants constants = features.class_constants(c);
    constants[gpu::kFeatureGuide] = constants[gpu::kFeaturePhotons] = true;
    builder.add(kernels.scatter_photons[c], "scatter_photons<" + class_name(material_class) + ">",
                surface_kernel_file(material_class, source), constants);
  }
  builder.build();
  return kernels;
}

void build_surface_kernels(const KernelSource& source, bool guided, Kernels& kernels) {
  KernelBuilder builder(source, kernels.run);
  for (size_t c = 0; c < source.features.classes.size(); ++c) {
    if (kernels.shade_surface[c]) continue;
    const MaterialClass& material_class = source.features.classes[c];
    SpecializationConstants constants = source.features.class_constants(c);
    constants[gpu::kFeatureGuide] = guided;
    builder.add(kernels.shade_surface[c], surface_kernel_name(material_class) + (guided ? " guided" : ""),
                surface_kernel_file(material_class, source), constants);
  }
  builder.build();
}

Kernels build_stages(const KernelSource& source, const BakedGeometry& walls, bool may_guide) {
  const FeatureSet& features = source.features;
  const SpecializationConstants common = features.constants();
  Kernels kernels;
  KernelBuilder builder(source, kernels.run);
  const auto add_if = [&](bool needed, Kernels::Pointer& kernel, const char* name, const std::string& file = {}) {
    if (needed)
      builder.add(kernel, name, file.empty() ? name : file, common);
    else
      kernels.skipped.push_back(name);
  };

  const auto add_trace = [&](bool needed, Kernels::Pointer& kernel, const char* name) {
    if (!needed || walls.count == 0) return add_if(needed, kernel, name, trace_kernel_file(name, source));
    SpecializationConstants constants = common;
    constants.insert(walls.constants.begin(), walls.constants.end());
    builder.add(kernel, name, trace_kernel_file(std::string(name) + "_walls", source), constants);
  };

  // Rays may go on at null surfaces whatever the depth.
  const bool bounces = features.max_depth > 1 || features.shadow_null, media = features.has_media();
  builder.add(kernels.init_from_camera, "init_from_camera", row_kernel_file("init_from_camera", source), common);
  builder.add(kernels.prepare_dispatch, "prepare_dispatch", "prepare_dispatch", common);
  add_trace(true, kernels.intersect_primary, "intersect_primary");
  add_trace(bounces, kernels.intersect_closest, "intersect_closest");
  add_if(features.area_lights(), kernels.shade_emitter, "shade_emitter");
  add_if(features.environment(), kernels.shade_escaped, "shade_escaped");
  if (bounces) kernels.shade_surface.resize(features.classes.size());
  for (size_t c = 0; c < features.classes.size(); ++c) {
    const MaterialClass& material_class = features.classes[c];
    const std::string name = surface_kernel_name(material_class);
    if (!bounces)
      kernels.skipped.push_back(name);
    else if (!may_guide || !can_be_guided(material_class))
      builder.add(kernels.shade_surface[c], name, surface_kernel_file(material_class, source),
                  features.class_constants(c));
  }
  if (features.classes.empty()) kernels.skipped.push_back("shade_surface");
  const bool shadow = features.selection != gpu::kSelectNone && features.strategy != gpu::kStrategyBsdf &&
                      (!features.classes.empty() || media) && features.max_depth > 1;
  // With several classes the kernel must know the materials of all of them.
  if (shadow && features.media != 0)
    builder.add(kernels.intersect_shadow, "intersect_shadow_transmittance",
                trace_kernel_file("intersect_shadow_transmittance", source), features.union_constants());
  else
    add_trace(shadow, kernels.intersect_shadow, "intersect_shadow");
  add_if(media, kernels.sample_medium, "sample_medium");
  add_if(media && features.max_depth > 1, kernels.shade_medium, "shade_medium",
         row_kernel_file("shade_medium", source));
  const bool segments = media && (features.media & gpu::kMediaSegments) && features.max_depth > 1;
  add_if(segments, kernels.shade_segment, "shade_segment");
  builder.add(kernels.write_film, "write_film", "write_film", common);
  const uint32_t moment = 1u << gpu::kAovMoment;
  if (features.aovs & ~moment) builder.add(kernels.write_aov, "write_aov", "write_aov", features.union_constants());
  if (features.aovs & moment) builder.add(kernels.write_moment, "write_moment", "write_moment", common);
  builder.build();
  return kernels;
}

}  // namespace tachylite
