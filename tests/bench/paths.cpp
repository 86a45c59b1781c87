#include "bench/paths.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "base/timer.h"
#include "bench/diffuse_scene.h"
#include "bench/embree_paths.h"
#include "bench/scenes.h"
#include "scene/load_xml.h"
#include "vulkan/vector_width.h"
#include "wavefront/renderer.h"

namespace tachylite::bench {
namespace {

constexpr int kCores = 2;
constexpr uint32_t kSamples = 32, kEmbreeSamples = 8, kRoomSamples = 8, kMaxDepth = 8;

glm::dvec3 mean(const FilmBuffer& film) {
  glm::dvec3 sum(0);
  const size_t pixels = static_cast<size_t>(film.width()) * static_cast<size_t>(film.height());
  for (size_t i = 0; i < pixels; ++i) sum += film.mean(i);
  return sum / static_cast<double>(pixels);
}

}  // namespace

RayShareResult bench_ray_share(const std::string& name, int repetitions) {
  const Scene scene = diffuse_scene(make_scene(name), kMaxDepth);
  const PackedScene packed = pack_scene(scene);
  vulkan::DevicePool pool({});
  RenderOptions options;
  options.samples = kRoomSamples;
  options.structure = KernelStructure::kStages;
  const vulkan::DevicePool::Devices devices = pool.side_by_side(count_devices(pool.one().info(), packed, options));
  double seconds = std::numeric_limits<double>::infinity();
  RayShareResult result;
  std::vector<double> shares;
  for (int i = 0; i < repetitions; ++i) {
    options.seed = static_cast<uint32_t>(i);
    options.timing = false;
    Renderer plain(devices, packed, options);
    const CpuTimer timer;
    plain.render();
    seconds = std::min(seconds, timer.seconds());
    options.timing = true;
    Renderer timed(devices, packed, options);
    timed.render();
    double rays = 0, all = 0;
    for (const auto& [kernel, time] : timed.statistics().kernels) {
      all += time.seconds;
      if (kernel.starts_with("intersect")) rays += time.seconds;
    }
    for (const auto& [kernel, time] : timed.statistics().kernels) result.kernels[kernel] = time.seconds / all;
    shares.push_back(rays / all);
  }
  std::ranges::nth_element(shares, shares.begin() + static_cast<ptrdiff_t>(shares.size() / 2));
  const double paths = static_cast<double>(packed.params.width) * packed.params.height * kRoomSamples;
  result.mpaths = 1e-6 * kCores * paths / seconds;
  result.share = shares[shares.size() / 2];
  return result;
}

PathsResult bench_paths(int repetitions) {
  LoadOptions load;
  load.parameters = {{"size", "512"}, {"max_depth", std::to_string(kMaxDepth)}, {"rr_depth", "1000"}};
  const Scene scene = load_scene(std::string(TACHYLITE_SOURCE_DIR) + "/scenes/cornell-box/scene.xml", load);
  const PackedScene packed = pack_scene(scene);
  const EmbreePaths embree(scene, packed);
  vulkan::prefer_wide_vectors();
  vulkan::Device device;
  RenderOptions options;
  options.samples = kSamples;

  PathsResult result;
  RenderStatistics statistics;
  glm::dvec3 ours(0), theirs(0);
  double seconds = std::numeric_limits<double>::infinity(), embree_seconds = seconds;
  for (int i = 0; i < repetitions; ++i) {
    options.seed = static_cast<uint32_t>(i);
    Renderer renderer(device, packed, options);
    CpuTimer timer;
    const FilmBuffer film = renderer.render();
    seconds = std::min(seconds, timer.seconds());
    statistics = renderer.statistics();
    ours += mean(film);
    timer = CpuTimer();
    theirs += embree.render(kEmbreeSamples, kMaxDepth, static_cast<uint64_t>(i), kCores);
    embree_seconds = std::min(embree_seconds, timer.seconds());
  }
  const double pixels = static_cast<double>(packed.params.width) * packed.params.height;
  result.mpaths = 1e-6 * kCores * pixels * kSamples / seconds;
  result.mrays = result.mpaths * static_cast<double>(statistics.closest_rays + statistics.shadow_rays) /
                 (pixels * kSamples);
  result.embree_mpaths = 1e-6 * kCores * pixels * kEmbreeSamples / embree_seconds;
  result.mean_ratio = (ours.x + ours.y + ours.z) / (theirs.x + theirs.y + theirs.z);
  return result;
}

}  // namespace tachylite::bench
