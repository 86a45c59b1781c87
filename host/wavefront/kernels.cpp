#include "wavefront/kernels.h"

#include <algorithm>
#include <bit>

#include "kernel_spirv.h"
#include "pack/pack_material.h"
#include "shared/aov.h"
#include "shared/material.h"
#include "shared/medium.h"
#include "wavefront/photon_guide.h"

namespace tachylite {
namespace {

using vulkan::Kernel;
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
std::string surface_kernel_file(const MaterialClass& c) { return "shade_surface" + bsdf_kernel_variant(c); }

// With what does not depend on the scene.
SpecializationConstants of_render(SpecializationConstants constants, const KernelSource& source) {
  constants[gpu::kFeatureSampler] =
      source.options.sampler == SamplerKind::kIndependent ? gpu::kSamplerIndependent : gpu::kSamplerSobol;
  constants[gpu::kFeatureLog2Samples] = static_cast<uint32_t>(std::bit_width(source.end_sample - 1));
  constants[gpu::kFeaturePixelList] = source.options.adaptive;
  return constants;
}

Kernels::Pointer make_kernel(const KernelSource& source, const std::string& name, const std::string& file,
                             SpecializationConstants constants, std::vector<std::string>& names) {
  names.push_back(name);
  auto kernel = std::make_unique<vulkan::Kernel>(source.device, source.table, name, kernel_spirv(file),
                                                 of_render(std::move(constants), source));
  source.made(*kernel);
  return kernel;
}

}  // namespace

Kernels build_fused_kernel(const KernelSource& source, const BakedGeometry& baked) {
  Kernels kernels;
  SpecializationConstants constants = source.features.union_constants();
  constants.insert(baked.constants.begin(), baked.constants.end());
  kernels.follow_paths = make_kernel(source, "follow_paths", baked.kernel, constants, kernels.run);
  kernels.skipped = {"tree", "path state and queues", "intersect_closest", "intersect_shadow", "shade_surface"};
  return kernels;
}

PhotonKernels build_photon_kernels(const KernelSource& source) {
  PhotonKernels kernels;
  const FeatureSet& features = source.features;
  kernels.init_from_lights =
      make_kernel(source, "init_from_lights", "init_from_lights", features.constants(), kernels.names);
  for (size_t c = 0; c < features.classes.size(); ++c) {
    const MaterialClass& material_class = features.classes[c];
    SpecializationConstants constants = features.class_constants(c);
    constants[gpu::kFeatureGuide] = constants[gpu::kFeaturePhotons] = true;
    kernels.scatter_photons.push_back(
        can_be_guided(material_class)
            ? make_kernel(source, "scatter_photons<" + class_name(material_class) + ">",
                          surface_kernel_file(material_class), constants, kernels.names)
            : nullptr);
  }
  return kernels;
}

void build_surface_kernels(const KernelSource& source, bool guided, Kernels& kernels) {
  for (size_t c = 0; c < source.features.classes.size(); ++c) {
    if (kernels.shade_surface[c]) continue;
    const MaterialClass& material_class = source.features.classes[c];
    SpecializationConstants constants = source.features.class_constants(c);
    constants[gpu::kFeatureGuide] = guided;
    kernels.shade_surface[c] =
        make_kernel(source, surface_kernel_name(material_class) + (guided ? " guided" : ""),
                    surface_kernel_file(material_class), constants, kernels.run);
  }
}

Kernels build_stages(const KernelSource& source, bool may_guide) {
  const FeatureSet& features = source.features;
  Kernels kernels;
  const auto make = [&](const std::string& name, const std::string& file, const SpecializationConstants& constants) {
    return make_kernel(source, name, file, constants, kernels.run);
  };
  const auto make_if = [&](bool needed, const char* name) -> Kernels::Pointer {
    if (needed) return make(name, name, features.constants());
    kernels.skipped.push_back(name);
    return nullptr;
  };

  // Rays may go on at null surfaces whatever the depth.
  const bool bounces = features.max_depth > 1 || features.shadow_null, media = features.has_media();
  kernels.init_from_camera = make("init_from_camera", "init_from_camera", features.constants());
  kernels.prepare_dispatch = make("prepare_dispatch", "prepare_dispatch", features.constants());
  kernels.intersect_primary = make("intersect_primary", "intersect_primary", features.constants());
  kernels.intersect_closest = make_if(bounces, "intersect_closest");
  kernels.shade_emitter = make_if(features.area_lights(), "shade_emitter");
  kernels.shade_escaped = make_if(features.environment(), "shade_escaped");
  for (size_t c = 0; c < features.classes.size(); ++c) {
    const std::string name = surface_kernel_name(features.classes[c]);
    if (may_guide && can_be_guided(features.classes[c]))
      kernels.shade_surface.push_back(nullptr);
    else if (bounces)
      kernels.shade_surface.push_back(make(name, surface_kernel_file(features.classes[c]),
                                           features.class_constants(c)));
    else
      kernels.skipped.push_back(name);
  }
  if (features.classes.empty()) kernels.skipped.push_back("shade_surface");
  const bool shadow = features.selection != gpu::kSelectNone && features.strategy != gpu::kStrategyBsdf &&
                      (!features.classes.empty() || media) && features.max_depth > 1;
  // With several classes the kernel must know the materials of all of them.
  if (shadow && features.media != 0)
    kernels.intersect_shadow =
        make("intersect_shadow_transmittance", "intersect_shadow_transmittance", features.union_constants());
  else
    kernels.intersect_shadow = make_if(shadow, "intersect_shadow");
  kernels.sample_medium = make_if(media, "sample_medium");
  kernels.shade_medium = make_if(media && features.max_depth > 1, "shade_medium");
  const bool segments = media && (features.media & gpu::kMediaSegments) && features.max_depth > 1;
  kernels.shade_segment = make_if(segments, "shade_segment");
  kernels.write_film = make("write_film", "write_film", features.constants());
  const uint32_t moment = 1u << gpu::kAovMoment;
  if (features.aovs & ~moment) kernels.write_aov = make("write_aov", "write_aov", features.union_constants());
  if (features.aovs & moment) kernels.write_moment = make("write_moment", "write_moment", features.constants());
  return kernels;
}

}  // namespace tachylite
