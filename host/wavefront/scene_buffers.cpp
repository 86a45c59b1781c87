#include "wavefront/scene_buffers.h"

#include <algorithm>
#include <bit>

#include "base/bulk_vector.h"
#include "shared/bindings.h"
#include "shared/counters.h"
#include "shared/guide.h"
#include "shared/path_state.h"

namespace tachylite {
namespace {

using vulkan::Binding;
using vulkan::BindingKind;

Binding texel(uint32_t number, VkFormat format) { return {number, BindingKind::kTexel, nullptr, format}; }
Binding storage(uint32_t number) { return {number, BindingKind::kStorage, nullptr, VK_FORMAT_UNDEFINED}; }

// needed: else there is no buffer.
BufferPlan scene_buffer(const char* name, std::vector<Binding> bindings, const auto& data, bool needed = true) {
  const uint64_t bytes = needed ? data.size() * sizeof(data[0]) : 0;
  return {name, std::move(bindings), data.data(), bytes, vulkan::Domain::kDevice, owns_pages(data)};
}
BufferPlan scene_buffer(const char* name, uint32_t binding, VkFormat format, const auto& data, bool needed = true) {
  return scene_buffer(name, {texel(binding, format)}, data, needed);
}

}  // namespace

std::vector<BufferPlan> plan_buffers(const vulkan::DeviceInfo& device, const PackedScene& s,
                                     const gpu::RenderParams& params, const WavePlan& plan, bool listed) {
  constexpr VkFormat kUint4 = VK_FORMAT_R32G32B32A32_UINT, kFloat4 = VK_FORMAT_R32G32B32A32_SFLOAT;
  const bool media = s.features.media != 0, lit = s.features.selection != gpu::kSelectNone;
  const auto& baked = plan.baked;
  const uint64_t film_rows = uint64_t{plan.pixels} * plan.blocks;
  const uint64_t cell_bins = plan.may_guide ? uint64_t{gpu::kGuideCellBins} * (1 + s.features.focusers) : 0;
  // What only the stages need.
  const uint64_t slots = baked ? 0 : plan.capacity;
  const uint64_t path_bytes = slots * sizeof(glm::vec4) * (media ? gpu::kPathRowsMedia : gpu::kPathRowsBase);
  const uint64_t queue_bytes = slots * sizeof(uint32_t) * (gpu::kQueueSurface + s.features.classes.size() + (s.media.empty() ? 0 : 1));
  const uint64_t shadow_bytes = lit ? slots * sizeof(glm::vec4) * (media ? gpu::kShadowRowsMedia : gpu::kShadowRows) : 0;
  const bool stages = !baked;
  std::vector<Binding> nodes{texel(gpu::kBindBvhNodes, kUint4)};
  std::vector<Binding> leaves{texel(gpu::kBindBvhLeaves, kFloat4), texel(gpu::kBindLeafInfo, kUint4)};
  std::vector<Binding> unused;
  const bool views = reads_storage(device, s);
  (views ? nodes : unused).push_back(storage(gpu::kBindBvhNodeRows));
  (views ? leaves : unused).push_back(storage(gpu::kBindBvhLeafRows));

  return {
      {"parameters", {{gpu::kBindParams, BindingKind::kUniform}}, &params, sizeof(params)},
      scene_buffer("tree nodes", std::move(nodes), s.bvh.nodes, stages),
      scene_buffer("tree leaves", std::move(leaves), s.bvh.leaves, stages),
      {"views of the tree", std::move(unused)},
      scene_buffer("triangles", gpu::kBindTriangles, kUint4, s.triangles, stages),
      scene_buffer("normals", gpu::kBindNormals, kFloat4, s.normals),
      scene_buffer("texture coordinates", gpu::kBindUvs, VK_FORMAT_R32G32_SFLOAT, s.uvs),
      scene_buffer("curved shapes", gpu::kBindCurved, kFloat4, s.curved, stages),
      scene_buffer("shapes", gpu::kBindShapes, kUint4, s.shapes, stages),
      scene_buffer("baked primitives", gpu::kBindBaked, kFloat4, baked ? baked->rows : plan.walls.rows),
      scene_buffer("mesh attributes", gpu::kBindAttributes, kFloat4, s.attributes),
      scene_buffer("materials", gpu::kBindMaterials, kUint4, s.materials),
      scene_buffer("textures", gpu::kBindTextures, kUint4, s.textures),
      scene_buffer("texels, 8 bit", gpu::kBindTexels8, VK_FORMAT_R8G8B8A8_UNORM, s.texels8),
      scene_buffer("texels, half", gpu::kBindTexels16, VK_FORMAT_R16G16B16A16_SFLOAT, s.texels16),
      scene_buffer("texels, float", gpu::kBindTexels32, kFloat4, s.texels32),
      scene_buffer("lights", gpu::kBindLights, kFloat4, s.lights),
      scene_buffer("light table", gpu::kBindLightTable, kUint4, s.light_table),
      scene_buffer("environment", gpu::kBindEnvironment, kFloat4, s.environment),
      scene_buffer("environment table", gpu::kBindEnvironmentCdf, kFloat4, s.environment_cdf),
      scene_buffer("media", gpu::kBindMedia, kFloat4, s.media),
      scene_buffer("grids", gpu::kBindGrids, VK_FORMAT_R32_SFLOAT, s.grids),
      {"path state", {texel(gpu::kBindPathTexels, kFloat4), storage(gpu::kBindPaths)}, nullptr, path_bytes},
      {"queues",
       {texel(gpu::kBindQueueTexels, VK_FORMAT_R32_UINT), storage(gpu::kBindQueues)},
       nullptr,
       queue_bytes},
      {"shadow rays", {texel(gpu::kBindShadowTexels, kFloat4), storage(gpu::kBindShadow)}, nullptr, shadow_bytes},
      {"counters", {storage(gpu::kBindCounters)}, nullptr, gpu::kCounterWords * sizeof(uint32_t),
       vulkan::Domain::kHost},
      {"film block", {storage(gpu::kBindFilm)}, nullptr, film_rows * sizeof(glm::vec4),
       vulkan::Domain::kHost},
      {"pixel list", {texel(gpu::kBindPixelList, VK_FORMAT_R32G32_UINT)}, nullptr,
       listed ? film_rows * sizeof(glm::uvec2) : 0, vulkan::Domain::kHost},
      scene_buffer("emission", gpu::kBindEmission, VK_FORMAT_R32_SFLOAT, s.emission, plan.may_guide),
      {"photons", {storage(gpu::kBindPhotons)}, nullptr, gpu::kGuideCells * cell_bins * sizeof(uint32_t)},
      {"guide", {texel(gpu::kBindGuide, VK_FORMAT_R32G32_UINT)}, nullptr,
       (gpu::kGuideCells + 1) * cell_bins * sizeof(glm::uvec2)},
      {"auxiliary channels", {storage(gpu::kBindAov)}, nullptr,
       film_rows * sizeof(glm::vec4) * static_cast<uint64_t>(std::popcount(s.features.aovs)), vulkan::Domain::kHost},
  };
}

bool reads_storage(const vulkan::DeviceInfo& device, const PackedScene& scene) {
  const uint64_t most = std::max(scene.bvh.nodes.size() * sizeof(scene.bvh.nodes[0]),
                                 scene.bvh.leaves.size() * sizeof(scene.bvh.leaves[0]));
  return device.slow_texel_fetches && device.int64 && most <= device.max_storage_buffer_range;
}

}  // namespace tachylite
