#include "command_info.h"

#include <map>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "command_device.h"

namespace tachylite {
namespace {

/// "3 (2 rectangle, 1 obj)" or "none".
template <typename Objects, typename Name>
std::string tally(const Objects& objects, Name name) {
  if (objects.empty()) return "none";
  std::map<std::string, size_t> counts;
  for (const auto& object : objects) ++counts[name(object)];
  std::vector<std::string> parts;
  for (const auto& [kind, count] : counts) parts.push_back(fmt::format("{} {}", count, kind));
  return fmt::format("{} ({})", objects.size(), fmt::join(parts, ", "));
}

std::string texture_kind(const Texture& texture) {
  if (const auto* bitmap = std::get_if<BitmapTexture>(&texture.kind))
    return fmt::format("bitmap {} x {}", bitmap->bitmap->width, bitmap->bitmap->height);
  return std::holds_alternative<CheckerboardTexture>(texture.kind) ? "checkerboard" : "mesh_attribute";
}

std::string depth_text(int depth) {
  return depth < 0 ? "unlimited" : fmt::format("{}", depth);
}

void print_scene(const Scene& scene, int index) {
  static const char* const cameras[] = {"perspective", "thinlens", "orthographic"};
  static const char* const filters[] = {"box", "tent", "gaussian"};
  static const char* const integrators[] = {"direct", "path", "volpath", "volpathmis"};
  const Sensor& sensor = scene.sensors[static_cast<size_t>(index)];
  fmt::print("scene        {}\n", scene.path);
  fmt::print("sensor       {} of {}: {}, {} x {} pixels, {} filter, {} samples\n", index,
             scene.sensors.size(), cameras[static_cast<int>(sensor.kind)], sensor.film.crop_width,
             sensor.film.crop_height, filters[static_cast<int>(sensor.film.filter)], sensor.sample_count);
  fmt::print("integrator   {}, depth {}, roulette from depth {}\n",
             integrators[static_cast<int>(scene.integrator.kind)], depth_text(scene.integrator.max_depth),
             scene.integrator.rr_depth);
  const auto plugin = [](const auto& object) { return object.plugin; };
  fmt::print("shapes       {}, {} triangles\n", tally(scene.shapes, plugin), count_triangles(scene));
  fmt::print("bsdfs        {}\n", tally(scene.bsdfs, plugin));
  fmt::print("emitters     {}\n", tally(scene.emitters, plugin));
  fmt::print("textures     {}\n", tally(scene.textures, texture_kind));
  fmt::print("media        {}\n", tally(scene.media, [](const Medium& medium) {
               return std::holds_alternative<HomogeneousMedium>(medium.kind) ? "homogeneous"
                                                                             : "heterogeneous";
             }));
}

/// The device asked for, or nothing (with the reason in `why`) where there is none at all.
std::optional<vulkan::DeviceInfo> find_device(const std::string& selector, std::string& why) {
  try {
    return vulkan::Device({selector, false}).info();
  } catch (const RenderError& error) {
    why = error.what();
    return std::nullopt;
  }
}

}  // namespace

int run_info(const InfoArguments& arguments) {
  const Scene scene = load_scene_of(arguments.scene);
  std::string why;
  const std::optional<vulkan::DeviceInfo> device = find_device(arguments.device, why);
  const PackedScene packed = pack_scene(scene, arguments.scene.sensor);
  print_scene(scene, arguments.scene.sensor);
  fmt::print("needs        {}\n", fmt::join(packed.features.present(), ", "));
  fmt::print("needs not    {}\n", fmt::join(packed.features.absent(), ", "));
  fmt::print("\nBVH, built in {:.2f} s\n{}", packed.bvh_seconds, describe(packed.bvh.statistics));

  if (!device) {
    fmt::print("\nno memory plan without a device: {}\n", why);
    return 0;
  }
  RenderOptions options;
  options.max_paths = arguments.max_paths;
  options.samples =
      static_cast<uint64_t>(scene.sensors[static_cast<size_t>(arguments.scene.sensor)].sample_count);
  const MemoryPlan plan = Renderer::plan_memory(*device, packed, options);
  fmt::print("\nmemory plan on {}\n", describe(*device));
  for (const MemoryPlan::Entry& entry : plan.buffers)
    fmt::print("  {:<24}{:>12} of at most {:>10}{}\n", entry.name, format_bytes(entry.bytes),
               format_bytes(entry.limit), entry.bytes > entry.limit ? "  TOO LARGE" : "");
  fmt::print("  {:<24}{:>12} of            {:>10}\n", "in all", format_bytes(plan.total()),
             format_bytes(device->device_memory));
  return 0;
}

}  // namespace tachylite
