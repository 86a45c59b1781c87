#include "measure/scaling.h"

#include <cmath>
#include <functional>
#include <map>

#include <fmt/format.h>

#include "base/check.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/scratch_folder.h"
#include "base/timer.h"
#include "measure/image_error.h"
#include "measure/scaling_scenes.h"
#include "measure/scene_renders.h"
#include "scene/load_xml.h"

namespace tachylite {
namespace {

constexpr uint64_t kSamples = 16;
constexpr double kMebibyte = 1024.0 * 1024.0;

/// Seconds of the chosen clock.
class StageTimer {
 public:
  explicit StageTimer(int cores) : cores_(cores) {}
  double seconds() const { return cores_ > 0 ? cpu_.seconds() / cores_ : wall_.seconds(); }

 private:
  int cores_;
  Timer wall_;
  CpuTimer cpu_;
};

struct Bench {
  vulkan::Device& device;
  int cores;
  std::filesystem::path folder;

  ScalingPoint measure(double x, const std::filesystem::path& file) const;
  ScalingPoint triangles(double x) const;
};

constexpr const char *kRead = "reading [s]", *kTree = "tree [s]", *kPack = "packing [s]", *kKernels = "kernels [s]",
                     *kRender = "16 samples [s]", *kDevice = "device memory [MiB]",
                     *kPeak = "peak memory [MiB]", *kError = "relMSE of 16 samples [1]",
                     *kReadPly = "reading PLY [s]", *kReadObj = "reading OBJ [s]";

ScalingPoint Bench::measure(double x, const std::filesystem::path& file) const {
  ScalingPoint point{x, {}};
  forget_peak_memory();
  const StageTimer load_timer(cores);
  const Scene scene = load_scene(file);
  point.values[kRead] = load_timer.seconds();
  const StageTimer pack_timer(cores);
  const PackedScene packed = pack_scene(scene);
  const double pack = pack_timer.seconds();
  // The parts are known by the wall clock; their shares split the chosen one's.
  const double share = packed.bvh_seconds / std::max(packed.bvh_seconds + packed.pack_seconds, 1e-9);
  point.values[kTree] = share * pack;
  point.values[kPack] = (1 - share) * pack;
  RenderOptions options;
  options.samples = kSamples;
  std::vector<Image> images;
  for (uint32_t seed : {1u, 2u}) {
    options.seed = seed;
    const StageTimer kernels_timer(cores);
    Renderer renderer(device, packed, options);
    point.values[kKernels] = kernels_timer.seconds();
    const StageTimer render_timer(cores);
    images.push_back(color_of(renderer.render().to_image()));
    point.values[kRender] = render_timer.seconds();
    point.values[kDevice] = static_cast<double>(renderer.statistics().device_bytes) / kMebibyte;
  }
  if (const uint64_t peak = peak_memory(); peak > 0) point.values[kPeak] = static_cast<double>(peak) / kMebibyte;
  double rel_mse = 0;
  const std::vector<std::vector<double>> errors = deviations(images, ErrorScale(mean_of(images)));
  for (double block : errors[0]) rel_mse += block;  // both have the same
  point.values[kError] = rel_mse;
  return point;
}

ScalingPoint Bench::triangles(double x) const {
  const auto count = static_cast<uint64_t>(x);
  ScalingPoint point = measure(x, write_triangles_scene(folder, count, MeshFormat::kPly));
  point.values[kReadPly] = point.values[kRead];
  const std::filesystem::path obj = write_triangles_scene(folder, count, MeshFormat::kObj);
  const StageTimer timer(cores);
  load_scene(obj);
  point.values[kReadObj] = timer.seconds();
  return point;
}

struct Plan {
  std::string title, x_label;
  std::vector<std::string> columns;
  std::vector<double> xs;
  std::function<ScalingPoint(const Bench&, double)> measure;
};

std::vector<double> powers(double first, double last, double step) {
  std::vector<double> values;
  for (double x = first; x < 1.001 * last; x *= step) values.push_back(std::round(x));
  return values;
}

const std::map<std::string, Plan>& plans() {
  static const std::map<std::string, Plan> all = {
      {"triangles",
       {"Time and memory against triangles", "triangles",
        {kReadPly, kReadObj, kTree, kPack, kKernels, kRender, kDevice, kPeak},
        powers(100, 1e7, std::sqrt(10)), [](const Bench& b, double x) { return b.triangles(x); }}},
      {"lights",
       {"Time, memory and error against lights", "emissive triangles",
        {kRead, kTree, kPack, kKernels, kRender, kDevice, kPeak, kError}, powers(1, 1e6, 10),
        [](const Bench& b, double x) { return b.measure(x, write_lights_scene(b.folder, static_cast<uint64_t>(x))); }}},
      {"depth",
       {"Time and error against depth", "segments of a path", {kRender, kError}, powers(1, 64, 2),
        [](const Bench& b, double x) { return b.measure(x, write_room_scene(b.folder, static_cast<int>(x), 256)); }}},
      {"resolution",
       {"Time and memory against resolution", "pixels a side", {kKernels, kRender, kDevice, kPeak}, powers(64, 2048, 2),
        [](const Bench& b, double x) { return b.measure(x, write_room_scene(b.folder, 6, static_cast<int>(x))); }}},
      {"materials",
       {"Time against materials", "classes of material", {kKernels, kRender, kDevice, kPeak},
        powers(1, most_material_classes(), 2),
        [](const Bench& b, double x) { return b.measure(x, write_materials_scene(b.folder, static_cast<int>(x))); }}}};
  return all;
}

}  // namespace

const std::vector<std::string>& scaling_names() {
  static const std::vector<std::string> names = {"triangles", "lights", "depth", "resolution", "materials"};
  return names;
}

ScalingSeries measure_scaling(const std::string& name, vulkan::Device& device, double most_seconds, int cores) {
  const auto plan = plans().find(name);
  CHECK(plan != plans().end());
  const ScratchFolder scratch;
  const Bench bench{device, cores, scratch.path()};
  ScalingSeries series{plan->second.title, plan->second.x_label, plan->second.columns, {}, ""};
  for (double x : plan->second.xs) {
    const StageTimer timer(cores);
    series.points.push_back(plan->second.measure(bench, x));
    if (timer.seconds() <= most_seconds || x == plan->second.xs.back()) continue;
    series.note = fmt::format("ended at {:g}, which took more than {:g} s", x, most_seconds);
    break;
  }
  return series;
}

}  // namespace tachylite
