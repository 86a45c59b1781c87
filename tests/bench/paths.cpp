#include "bench/paths.h"

#include <algorithm>
#include <limits>

#include "base/timer.h"
#include "bench/embree_paths.h"
#include "scene/load_xml.h"
#include "wavefront/renderer.h"

namespace tachylite::bench {
namespace {

constexpr int kCores = 2;
constexpr uint32_t kSamples = 32, kEmbreeSamples = 8, kMaxDepth = 8;

glm::dvec3 mean(const FilmBuffer& film) {
  glm::dvec3 sum(0);
  const size_t pixels = static_cast<size_t>(film.width()) * static_cast<size_t>(film.height());
  for (size_t i = 0; i < pixels; ++i) sum += film.mean(i);
  return sum / static_cast<double>(pixels);
}

}  // namespace

PathsResult bench_paths(int repetitions) {
  LoadOptions load;
  load.parameters = {{"size", "512"}, {"max_depth", std::to_string(kMaxDepth)}, {"rr_depth", "1000"}};
  const Scene scene = load_scene(std::string(TACHYLITE_SOURCE_DIR) + "/scenes/cornell-box/scene.xml", load);
  const PackedScene packed = pack_scene(scene);
  const EmbreePaths embree(scene, packed);
  vulkan::Device device;
  RenderOptions options;
  options.samples = kSamples;

  PathsResult result;
  glm::dvec3 ours(0), theirs(0);
  double seconds = std::numeric_limits<double>::infinity(), embree_seconds = seconds;
  for (int i = 0; i < repetitions; ++i) {
    options.seed = static_cast<uint32_t>(i);
    Renderer renderer(device, packed, options);
    CpuTimer timer;
    const FilmBuffer film = renderer.render();
    seconds = std::min(seconds, timer.seconds());
    ours += mean(film);
    timer = CpuTimer();
    theirs += embree.render(kEmbreeSamples, kMaxDepth, static_cast<uint64_t>(i), kCores);
    embree_seconds = std::min(embree_seconds, timer.seconds());
  }
  const double pixels = static_cast<double>(packed.params.width) * packed.params.height;
  result.mpaths = 1e-6 * kCores * pixels * kSamples / seconds;
  result.embree_mpaths = 1e-6 * kCores * pixels * kEmbreeSamples / embree_seconds;
  result.mean_ratio = (ours.x + ours.y + ours.z) / (theirs.x + theirs.y + theirs.z);
  return result;
}

}  // namespace tachylite::bench
