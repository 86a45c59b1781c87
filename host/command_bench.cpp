#include "command_bench.h"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <optional>
#include <thread>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/scratch_folder.h"
#include "base/timer.h"
#include "command_device.h"
#include "command_output.h"
#include "image/exr.h"
#include "measure/contest.h"
#include "measure/external.h"
#include "measure/report_html.h"
#include "measure/report_json.h"
#include "measure/report_plots.h"
#include "measure/report_text.h"
#include "measure/scaling.h"
#include "measure/scene_renders.h"
#include "pack/bake_geometry.h"
#include "vulkan/vector_width.h"

namespace tachylite {
namespace {

void check_report_outputs(const BenchArguments& arguments) {
  for (const std::filesystem::path& file : arguments.outputs) {
    if (file.extension() != ".json" && file.extension() != ".html" && file.extension() != ".svg")
      throw InputError(fmt::format("-o {}: expected a name that ends in .json, .html or .svg", file.string()));
    check_writable(file);
  }
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  write_atomically(file, [&](const std::filesystem::path& path) {
    std::ofstream out(path, std::ios::binary);
    out << text;
    out.close();
    if (!out) throw RenderError("cannot write " + file.string());
  });
}

/// "cornell-box" of scenes/cornell-box/scene.xml, else the file's own name without its ending.
std::string name_of(const std::filesystem::path& file) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path().filename();
  return file.stem() == "scene" && !folder.empty() ? folder.string() : file.stem().string();
}

std::filesystem::path reference_of(const BenchArguments& arguments, const std::filesystem::path& scene) {
  if (!arguments.reference.empty()) return arguments.reference;
  std::filesystem::path beside = scene;
  beside.replace_extension(".reference.exr");
  return std::filesystem::exists(beside) ? beside : std::filesystem::path();
}

Contestant external_contestant(const ExternalRenderer& renderer, const BenchArguments& arguments,
                               const std::filesystem::path& scene, const ScratchFolder& scratch) {
  std::map<std::string, std::string> words = {{"scene", std::filesystem::absolute(scene).string()},
                                              {"out", (scratch.path() / "image.exr").string()},
                                              {"defines", ""}};
  for (const std::string& define : arguments.scene.defines)
    words["defines"] += fill_command({"", " -D {define}", 0}, {{"define", define}});
  return {renderer.name,
          [renderer, words](uint64_t samples, uint32_t seed) mutable {
            words["samples"] = std::to_string(samples);
            words["seed"] = std::to_string(seed);
            return run_external(renderer, fill_command(renderer, words), words.at("out"));
          },
          renderer.most_samples};
}

SceneMeasurement bench_scene(const BenchArguments& arguments, const MeasureOptions& measure,
                             const std::filesystem::path& file, std::span<const ExternalRenderer> externals,
                             vulkan::DevicePool& devices) {
  SceneMeasurement result;
  result.name = name_of(file);
  result.file = file.string();
  const Timer wall;
  const CpuTimer cpu;
  SceneArguments which = arguments.scene;
  which.file = file;
  const Scene scene = load_scene_of(which);
  result.start.emplace_back("reading the scene", wall.seconds());
  const std::filesystem::path reference_file = reference_of(arguments, file);
  result.error_from = reference_file.empty() ? "seed pairs" : reference_file.string();
  std::optional<Image> reference;
  if (!reference_file.empty()) reference = read_exr(reference_file);
  log_info(summarize(scene, which.sensor));
  const PackedScene packed = pack_scene(scene, which.sensor);
  result.start.emplace_back("tree", packed.bvh_seconds);
  result.start.emplace_back("packing", packed.pack_seconds);

  RenderOptions options;
  options.sampler = arguments.sampler;
  options.guiding = arguments.guiding;
  options.max_paths = arguments.max_paths;
  const Seconds before{cpu.seconds(), wall.seconds()};
  const SceneRenders renders(devices, packed, options, before);
  const ScratchFolder scratch;
  std::vector<Contestant> contestants = {
      {"tachylite", [&](uint64_t samples, uint32_t seed) { return renders.render(samples, seed); }, 0}};
  RenderOptions adaptive_options = options;
  adaptive_options.adaptive = true;
  const SceneRenders adaptive_renders(devices, packed, adaptive_options, before);
  if (arguments.adaptive)
    contestants.push_back(
        {"adaptive", [&](uint64_t samples, uint32_t seed) { return adaptive_renders.render(samples, seed); }, 0});
  for (const ExternalRenderer& renderer : externals)
    contestants.push_back(external_contestant(renderer, arguments, file, scratch));
  measure_scene(result, contestants, reference ? &*reference : nullptr, measure);
  result.start.emplace_back("kernels", renders.compile().wall);
  result.stages = renders.stage_times(std::min<uint64_t>(measure.most_samples, 64));
  return result;
}

}  // namespace

int run_bench(const BenchArguments& arguments) {
  // Refuse what cannot succeed before the long work begins.
  if (arguments.scenes.empty() && arguments.scaling.empty())
    throw InputError("bench: expected a scene, or --scaling");
  if (!arguments.reference.empty() && arguments.scenes.size() != 1)
    throw InputError("--reference: it belongs to one scene");
  if (sample_levels(arguments.measure).empty())
    throw InputError(fmt::format("--min-spp {}: expected no more than --spp {}", arguments.measure.least_samples,
                                 arguments.measure.most_samples));
  check_report_outputs(arguments);
  std::vector<ExternalRenderer> externals;
  for (const std::string& text : arguments.externals) externals.push_back(parse_external(text));
  std::optional<Report> baseline;
  if (!arguments.against.empty()) baseline = read_report(arguments.against);
  bool all_baked = arguments.scaling.empty();
  for (const std::filesystem::path& file : arguments.scenes) {
    SceneArguments which = arguments.scene;
    which.file = file;
    const Scene scene = load_scene_of(which);
    all_baked = all_baked && pack_if_baked(scene, which.sensor);
  }

  if (all_baked) vulkan::prefer_wide_vectors();
  vulkan::DevicePool pool(device_options(arguments.device));
  vulkan::Device& device = pool.one();
  Report report;
  report.version = TACHYLITE_VERSION;
  report.device = device.info().name;
  report.driver = fmt::format("{} {}", device.info().driver, device.info().driver_version);
  MeasureOptions measure = arguments.measure;
  measure.cpu_clock = arguments.clock == "auto" ? device.is_cpu() : arguments.clock == "cpu";
  measure.cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  report.clock = measure.cpu_clock ? "CPU" : "wall";
  report.cores = measure.cores;
  ProgressDisplay display(arguments.quiet);
  const Timer timer;
  std::string scene_name;
  measure.progress = [&](const std::string& what, double fraction) {
    display.update({fraction, 0, 0, timer.seconds(), 0, 0});
    if (isatty(STDERR_FILENO) == 0) log_info(fmt::format("{:3.0f} % {}: {}", 100 * fraction, scene_name, what));
  };
  for (const std::filesystem::path& file : arguments.scenes) {
    scene_name = name_of(file);
    report.scenes.push_back(bench_scene(arguments, measure, file, externals, pool));
  }
  for (const std::string& name : arguments.scaling) {
    log_info("scaling: " + name);
    report.scaling.push_back(measure_scaling(name, device, arguments.scaling_seconds, measure.cpu_clock ? measure.cores : 0));
  }
  display.finish();
  check_validation(pool.validation_messages());

  if (baseline) report.against = compare_reports(report, *baseline);
  for (const std::filesystem::path& file : arguments.outputs)
    write_text(file, file.extension() == ".json"  ? report_json(report)
                     : file.extension() == ".svg" ? report_svg(report)
                                                  : report_html(report));
  const std::string text = arguments.json ? report_json(report) : describe(report);
  std::fputs(text.c_str(), stdout);
  return 0;
}

}  // namespace tachylite
