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
SpecializationConstants of_render(SpecializationConstants constants, const RenderOptions& options, uint64_t end_sample) {
  constants[gpu::kFeatureSampler] =
      options.sampler == SamplerKind::kIndependent ? gpu::kSamplerIndependent : gpu::kSamplerSobol;
  constants[gpu::kFeatureLog2Samples] = static_cast<uint32_t>(std::bit_width(end_sample - 1));
  constants[gpu::kFeaturePixelList] = options.adaptive;
  return constants;
}

}  // namespace

PhotonKernels build_photon_kernels(vulkan::Device& device, const vulkan::BindingTable& table,
                                   const FeatureSet& features, const RenderOptions& options, uint64_t end_sample) {
  PhotonKernels kernels;
  const auto make = [&](const std::string& name, const std::string& file, SpecializationConstants constants) {
    kernels.names.push_back(name);
    return std::make_unique<Kernel>(device, table, name, kernel_spirv(file),
                                    of_render(std::move(constants), options, end_sample));
  };
  kernels.init_from_lights = make("init_from_lights", "init_from_lights", features.constants());
  for (size_t c = 0; c < features.classes.size(); ++c) {
    const MaterialClass& material_class = features.classes[c];
    SpecializationConstants constants = features.class_constants(c);
    constants[gpu::kFeatureGuide] = constants[gpu::kFeaturePhotons] = true;
    kernels.scatter_photons.push_back(can_be_guided(material_class)
                                          ? make("scatter_photons<" + class_name(material_class) + ">",
                                                 surface_kernel_file(material_class), constants)
                                          : nullptr);
  }
  return kernels;
}

void guide_kernels(vulkan::Device& device, const vulkan::BindingTable& table, const FeatureSet& features,
                   const RenderOptions& options, uint64_t end_sample, Kernels& kernels) {
  for (size_t c = 0; c < features.classes.size(); ++c) {
    const MaterialClass& material_class = features.classes[c];
    if (!can_be_guided(material_class)) continue;
    SpecializationConstants constants = of_render(features.class_constants(c), options, end_sample);
    constants[gpu::kFeatureGuide] = true;
    const std::string before = surface_kernel_name(material_class), name = before + " guided";
    kernels.shade_surface[c] = std::make_unique<Kernel>(
        device, table, name, kernel_spirv(surface_kernel_file(material_class)), constants);
    std::replace(kernels.run.begin(), kernels.run.end(), before, name);
  }
}

Kernels build_kernels(vulkan::Device& device, const vulkan::BindingTable& table, const FeatureSet& features,
                      const RenderOptions& options, uint64_t end_sample, const BakedGeometry* baked) {
  const auto with_render = [&](SpecializationConstants constants) {
    return of_render(std::move(constants), options, end_sample);
  };
  const SpecializationConstants common = with_render(features.constants());

  Kernels kernels;
  const auto make = [&](const std::string& name, const std::string& file, const SpecializationConstants& constants) {
    kernels.run.push_back(name);
    return std::make_unique<Kernel>(device, table, name, kernel_spirv(file), constants);
  };
  if (baked) {
    SpecializationConstants constants = with_render(features.union_constants());
    constants.insert(baked->constants.begin(), baked->constants.end());
    kernels.follow_paths = make("follow_paths", baked->kernel, constants);
    kernels.skipped = {"tree", "path state and queues", "intersect_closest", "intersect_shadow", "shade_surface"};
    return kernels;
  }

  const auto make_if = [&](bool needed, const char* name) -> Kernels::Pointer {
    if (needed) return make(name, name, common);
    kernels.skipped.push_back(name);
    return nullptr;
  };

  // Rays may go on at null surfaces whatever the depth.
  const bool bounces = features.max_depth > 1 || features.shadow_null, media = features.has_media();
  kernels.init_from_camera = make("init_from_camera", "init_from_camera", common);
  kernels.prepare_dispatch = make("prepare_dispatch", "prepare_dispatch", common);
  kernels.intersect_primary = make("intersect_primary", "intersect_primary", common);
  kernels.intersect_closest = make_if(bounces, "intersect_closest");
  kernels.shade_emitter = make_if(features.area_lights(), "shade_emitter");
  kernels.shade_escaped = make_if(features.environment(), "shade_escaped");
  for (size_t c = 0; c < features.classes.size(); ++c) {
    const std::string name = surface_kernel_name(features.classes[c]);
    if (bounces)
      kernels.shade_surface.push_back(make(name, surface_kernel_file(features.classes[c]),
                                           with_render(features.class_constants(c))));
    else
      kernels.skipped.push_back(name);
  }
  if (features.classes.empty()) kernels.skipped.push_back("shade_surface");
  const bool shadow = features.selection != gpu::kSelectNone && features.strategy != gpu::kStrategyBsdf &&
                      (!features.classes.empty() || media) && features.max_depth > 1;
  // With several classes the kernel must know the materials of all of them.
  if (shadow && features.media != 0)
    kernels.intersect_shadow =
        make("intersect_shadow_transmittance", "intersect_shadow_transmittance", with_render(features.union_constants()));
  else
    kernels.intersect_shadow = make_if(shadow, "intersect_shadow");
  kernels.sample_medium = make_if(media, "sample_medium");
  kernels.shade_medium = make_if(media && features.max_depth > 1, "shade_medium");
  const bool segments = media && (features.media & gpu::kMediaSegments) && features.max_depth > 1;
  kernels.shade_segment = make_if(segments, "shade_segment");
  kernels.write_film = make("write_film", "write_film", common);
  const uint32_t moment = 1u << gpu::kAovMoment;
  if (features.aovs & ~moment) kernels.write_aov = make("write_aov", "write_aov", with_render(features.union_constants()));
  if (features.aovs & moment) kernels.write_moment = make("write_moment", "write_moment", common);
  return kernels;
}

}  // namespace tachylite
