#include "bench/bounces.h"

#include <algorithm>
#include <array>
#include <limits>

#include "base/timer.h"
#include "bench/diffuse_scene.h"
#include "bench/embree_bounces.h"
#include "bench/ray_sets.h"
#include "shared/bindings.h"
#include "test_kernel_spirv.h"
#include "vulkan/commands.h"
#include "vulkan/vector_width.h"

namespace tachylite::bench {
namespace {

constexpr int kCores = 2;
constexpr uint32_t kBounces = 32, kLanesPerGroup = 64;

struct Push {
  glm::vec4 corner, edge_u, edge_v;
  uint32_t count, bounces;
};

/// The kernel bounce_baked.comp, of one scene.
class BakedBounces {
 public:
  BakedBounces(vulkan::Device& device, const BenchScene& scene, std::span<const test::TraceRay> primary, bool shadow)
      : commands_(device),
        baked_(bake_scene(scene)),
        rows_(device, std::span(baked_.rows)),
        rays_(device, primary),
        sums_(device, primary.size() * sizeof(glm::vec2)),
        table_(device, bindings()),
        name_(shadow ? "bounce_baked_shadow" : "bounce_baked"),
        kernel_(device, table_, name_, test_kernel_spirv(name_), baked_.constants),
        push_{glm::vec4(scene.light.corner, 0), glm::vec4(scene.light.edge_u, 0), glm::vec4(scene.light.edge_v, 0),
              static_cast<uint32_t>(primary.size()), kBounces} {}

  void run() {
    commands_.dispatch(kernel_, (push_.count + kLanesPerGroup - 1) / kLanesPerGroup, &push_, sizeof push_);
    commands_.submit_and_wait();
  }

  BounceSums sums() const {
    BounceSums total;
    for (const glm::vec2& lane : sums_.download_all<glm::vec2>()) {
      total.distances += lane.x;
      total.seen += lane.y;
    }
    return total;
  }

 private:
  std::array<vulkan::Binding, 3> bindings() const {
    using vulkan::BindingKind;
    return {{{gpu::kBindBaked, BindingKind::kTexel, &rows_, VK_FORMAT_R32G32B32A32_SFLOAT},
             {gpu::kBindPathTexels, BindingKind::kTexel, &rays_, VK_FORMAT_R32G32B32A32_SFLOAT},
             {gpu::kBindPaths, BindingKind::kStorage, &sums_, VK_FORMAT_UNDEFINED}}};
  }

  vulkan::Commands commands_;
  const BakedGeometry baked_;
  vulkan::Buffer rows_, rays_, sums_;
  vulkan::BindingTable table_;
  std::string name_;
  vulkan::Kernel kernel_;
  Push push_;
};

BouncesResult bench(vulkan::Device& device, const BenchScene& scene, bool shadow, int repetitions) {
  const EmbreeScene embree(scene.mesh);
  const std::vector<test::TraceRay> primary = make_ray_sets(scene, embree)[0].rays;
  const EmbreeBounces yardstick(scene, embree);
  BakedBounces bounces(device, scene, primary, shadow);
  bounces.run();  // compiles
  BounceSums theirs;
  double seconds = std::numeric_limits<double>::infinity(), embree_seconds = seconds;
  for (int i = 0; i < repetitions; ++i) {
    CpuTimer timer;
    theirs = yardstick.trace(primary, kBounces, shadow, kCores);
    embree_seconds = std::min(embree_seconds, timer.seconds());
    timer = CpuTimer();
    bounces.run();
    seconds = std::min(seconds, timer.seconds());
  }
  const BounceSums ours = bounces.sums();
  const double mrays = 1e-6 * static_cast<double>(primary.size()) * kBounces * (shadow ? 2 : 1);
  return {scene.name,
          shadow ? "bounces, shadow" : "bounces",
          kCores * mrays / seconds,
          kCores * mrays / embree_seconds,
          ours.distances / theirs.distances,
          shadow ? ours.seen / theirs.seen : 1};
}

}  // namespace

std::vector<BouncesResult> bench_bounces(const std::string& only, int repetitions) {
  vulkan::prefer_wide_vectors();
  vulkan::Device device;
  std::vector<BouncesResult> results;
  for (const std::string& name : only.empty() ? tiny_scene_names() : std::vector{only}) {
    const BenchScene scene = make_scene(name);
    for (const bool shadow : {false, true}) results.push_back(bench(device, scene, shadow, repetitions));
  }
  return results;
}

}  // namespace tachylite::bench
