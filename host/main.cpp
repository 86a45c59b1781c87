// The command line: options into the structs of the commands, exceptions into exit codes.

#include <cerrno>
#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel.h"
#include "command_bench.h"
#include "command_compare.h"
#include "command_devices.h"
#include "command_film.h"
#include "command_info.h"
#include "command_interrupt.h"
#include "command_reference.h"
#include "command_verify.h"
#include "measure/scaling.h"
#include "shared/render_params.h"

namespace tachylite {
namespace {

constexpr int kExitFailed = 1, kExitBadInput = 2;
constexpr uint32_t kMostPaths = uint32_t{1} << 26;
constexpr int kMostThreads = 1024;
constexpr uint32_t kMostDevices = 64;

void add_scene_options(CLI::App& command, SceneArguments& scene) {
  command.add_option("scene", scene.file, "Mitsuba 3 scene")->required()->type_name("SCENE.xml");
  command.add_option("-D", scene.defines, "value of the scene's $name")
      ->type_name("name=value")
      ->allow_extra_args(false);
  command.add_option("--sensor", scene.sensor, "which of the scene's sensors, from 0")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--permissive", scene.permissive, "unknown plugins and parameters are warnings only");
}

void add_paths_option(CLI::App& command, uint32_t& max_paths) {
  command.add_option("--max-paths", max_paths, "paths in flight on the device; as many as keep it busy unless given")
      ->type_name("N")
      ->check(CLI::Range(1u, kMostPaths));
}

void add_device_option(CLI::App& command, std::string& device) {
  command.add_option("--device", device, "Vulkan device: its number or a part of its name")
      ->type_name("INDEX|NAME");
}

void add_threads_option(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "threads of the host; 0: one a core")
      ->type_name("N")
      ->check(CLI::Range(0, kMostThreads));
}

void add_sampler_option(CLI::App& command, SamplerKind& sampler) {
  static const std::map<std::string, SamplerKind> names = {{"sobol", SamplerKind::kSobol},
                                                           {"independent", SamplerKind::kIndependent}};
  command.add_option("--sampler", sampler, "sobol (default) or independent")
      ->type_name("NAME")
      ->transform(CLI::CheckedTransformer(names).description(""));
}

void add_guiding_option(CLI::App& command, Guiding& guiding) {
  static const std::map<std::string, Guiding> names = {{"auto", Guiding::kAuto}, {"on", Guiding::kOn}, {"off", Guiding::kOff}};
  command.add_option("--guiding", guiding, "paths by photons: auto (default: where they find caustics), on or off")
      ->type_name("NAME")
      ->transform(CLI::CheckedTransformer(names).description(""));
}

void add_seed_option(CLI::App& command, std::optional<uint32_t>& seed) {
  command.add_option("--seed", seed, "of the random numbers")
      ->type_name("N")
      ->check(CLI::Range(int64_t{0}, int64_t{std::numeric_limits<uint32_t>::max()}));
}

/// CLI::Range lets NaN through.
CLI::Validator within(double low, double high) {
  return CLI::Validator(
      [low, high](const std::string& text) {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        return good ? std::string() : fmt::format("{} is not a number from {:g} to {:g}", text, low, high);
      },
      "");
}

void add_time_option(CLI::App& command, double& time) {
  command.add_option("--time", time, "stop after so many seconds of rendering")
      ->type_name("SECONDS")
      ->check(within(1e-3, 1e9));
}

void add_quiet_option(CLI::App& command, bool& quiet) {
  command.add_flag("--quiet", quiet, "nothing on the terminal but errors");
}

/// The options that render and reference have in common.
void add_render_options(CLI::App& command, RenderArguments& arguments, int& threads) {
  const auto sample_range = CLI::Range(int64_t{1}, static_cast<int64_t>(kEndlessSamples));
  add_scene_options(command, arguments.scene);
  command.add_option("-o,--output", arguments.outputs, "image, .exr or .png; may be given several times")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command.add_option("--spp", arguments.samples, "samples a pixel")->type_name("N")->check(sample_range);
  add_seed_option(command, arguments.seed);
  add_time_option(command, arguments.time);
  command.add_option("--error", arguments.error, "stop at this relative standard error of the mean pixel")
      ->type_name("E")
      ->check(within(1e-9, 1e3));
  add_device_option(command, arguments.device);
  add_sampler_option(command, arguments.sampler);
  add_paths_option(command, arguments.max_paths);
  add_threads_option(command, threads);
  command.add_option("--aov", arguments.scene.aovs, "further layers: albedo,normal,depth,position,uv,prim_index,shape_index,sample_count...")
      ->type_name("LIST")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--first-sample", arguments.first_sample, "number of the first sample")
      ->type_name("N")
      ->check(CLI::Range(int64_t{0}, static_cast<int64_t>(kEndlessSamples)))
      ->check([](const std::string& text) {
        return std::stoull(text) % gpu::kBlockSamples == 0
                   ? std::string()
                   : fmt::format("{} is not a multiple of {}", text, gpu::kBlockSamples);
      });
  command.add_option("--resume", arguments.resume, "goes on with the samples that FILE.exr has; the output, without FILE")
      ->type_name("[FILE.exr]")
      ->expected(0, 1);
  command.add_flag("!--no-sums", arguments.sums, "leaves out what merge and --resume need: smaller files");
  command.add_option("--stats", arguments.stats, "where time, rays and memory went, as JSON")
      ->type_name("FILE.json");
  add_quiet_option(command, arguments.quiet);
}

void add_bench_options(CLI::App& command, BenchArguments& arguments, int& threads) {
  const auto samples = CLI::Range(int64_t{1}, int64_t{1} << 20);
  command.add_option("scenes", arguments.scenes, "Mitsuba 3 scenes")->type_name("SCENE.xml");
  command.add_option("-D", arguments.scene.defines, "value of the scenes' $name")
      ->type_name("name=value")
      ->allow_extra_args(false);
  command.add_flag("--permissive", arguments.scene.permissive, "unknown plugins and parameters are warnings only");
  command.add_option("-o,--output", arguments.outputs, "report, .json or .html, or its plots, .svg; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command.add_option("--spp", arguments.measure.most_samples, "most samples a pixel")->type_name("N")->check(samples);
  command.add_option("--min-spp", arguments.measure.least_samples, "least samples a pixel; doubled from there")
      ->type_name("N")
      ->check(samples);
  command.add_option("--seeds", arguments.measure.seeds, "images of each number of samples")
      ->type_name("N")
      ->check(CLI::Range(3, 1000));
  command.add_option("--seed", arguments.measure.first_seed, "the first of the seeds")
      ->type_name("N")
      ->check(CLI::Range(0u, 1u << 31));
  command.add_option("--reference", arguments.reference, "what errors are against; else SCENE.reference.exr, or pairs")
      ->type_name("FILE.exr");
  command.add_option("--external", arguments.externals, "a further renderer")
      ->type_name("'name=NAME;spp=MOST;command=...'")
      ->allow_extra_args(false);
  command.add_flag("--adaptive", arguments.adaptive, "adaptive sampling beside the usual");
  command.add_option("--against", arguments.against, "an earlier report, for ratios")->type_name("BASELINE.json");
  command.add_option("--scaling", arguments.scaling, "cost as work grows: " + fmt::format("{}", fmt::join(scaling_names(), ",")))
      ->type_name("LIST")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(scaling_names()).description(""));
  command
      .add_option("--scaling-seconds", arguments.scaling_seconds,
                  "a point that takes longer, by --clock, is its series' last")
      ->type_name("SECONDS")
      ->check(within(1e-3, 1e9));
  command.add_option("--clock", arguments.clock, "cpu (seconds over cores) or wall; auto: cpu where the device is one")
      ->type_name("NAME")
      ->check(CLI::IsMember({"auto", "cpu", "wall"}).description(""));
  add_device_option(command, arguments.device);
  add_sampler_option(command, arguments.sampler);
  add_guiding_option(command, arguments.guiding);
  add_paths_option(command, arguments.max_paths);
  add_threads_option(command, threads);
  command.add_flag("--json", arguments.json, "the report on stdout as JSON");
  add_quiet_option(command, arguments.quiet);
}

int run(int argc, char** argv) {
  CLI::App app("Tachylite: a Vulkan compute path tracer for Mitsuba 3 scenes", "tachylite");
  app.set_version_flag("--version", "tachylite " TACHYLITE_VERSION);
  app.require_subcommand(1);
  app.failure_message([&app](const CLI::App*, const CLI::Error& error) {
    const std::vector<std::string> unknown = app.remaining();
    return unknown.empty()
               ? fmt::format("{}; --help shows what there is\n", error.what())
               : fmt::format("unknown: {}; --help shows what there is\n", fmt::join(unknown, " "));
  });

  int threads = 0;
  RenderArguments render;
  CLI::App& render_command = *app.add_subcommand("render", "renders on a Vulkan device");
  add_render_options(render_command, render, threads);
  render_command
      .add_flag("--adaptive", render.adaptive, "more samples where the image is noisier, without bias; N is their mean")
      ->excludes("--resume");
  add_guiding_option(render_command, render.guiding);
  render_command
      .add_option("--side-by-side", render.devices, "so many of the device share the work; as many as pay unless given")
      ->type_name("N")
      ->check(CLI::Range(1u, kMostDevices));

  RenderArguments reference;
  CLI::App& reference_command = *app.add_subcommand("reference", "renders on the CPU reference");
  add_render_options(reference_command, reference, threads);

  VerifyArguments verify;
  CLI::App& verify_command = *app.add_subcommand("verify", "judges the device by the reference");
  add_scene_options(verify_command, verify.scene);
  add_seed_option(verify_command, verify.seed);
  add_time_option(verify_command, verify.time);
  add_device_option(verify_command, verify.device);
  add_sampler_option(verify_command, verify.sampler);
  add_guiding_option(verify_command, verify.guiding);
  add_paths_option(verify_command, verify.max_paths);
  add_threads_option(verify_command, threads);
  add_quiet_option(verify_command, verify.quiet);

  CompareArguments compare;
  CLI::App& compare_command = *app.add_subcommand("compare", "differences of two images, and a test of them");
  compare_command.add_option("a", compare.a)->required()->type_name("A.exr");
  compare_command.add_option("b", compare.b)->required()->type_name("B.exr");
  CLI::Option* variance =
      compare_command.add_option("--variance", compare.variance, "variance of one sample")
          ->type_name("VAR.exr");
  CLI::Option* samples = compare_command.add_option("--spp", compare.samples, "samples in a pixel of A")
                             ->type_name("N")
                             ->check(CLI::Range(int64_t{1}, std::numeric_limits<int64_t>::max()));
  variance->needs(samples);
  samples->needs(variance);
  compare_command.add_flag("--json", compare.json, "figures as JSON");

  BenchArguments bench;
  CLI::App& bench_command = *app.add_subcommand("bench", "error against time");
  add_bench_options(bench_command, bench, threads);

  MergeArguments merge;
  CLI::App& merge_command = *app.add_subcommand("merge", "joins renders of disjoint samples, bit for bit");
  merge_command.add_option("inputs", merge.inputs)->required()->type_name("A.exr B.exr ...");
  merge_command.add_option("-o,--output", merge.outputs, "image, .exr or .png; may be given several times")
      ->required()
      ->type_name("FILE")
      ->allow_extra_args(false);
  add_quiet_option(merge_command, merge.quiet);

  InfoArguments info;
  CLI::App& info_command = *app.add_subcommand("info", "what a scene holds and needs; renders nothing");
  add_scene_options(info_command, info.scene);
  add_device_option(info_command, info.device);
  add_paths_option(info_command, info.max_paths);
  add_threads_option(info_command, threads);

  CLI::App& devices_command = *app.add_subcommand("devices", "Vulkan devices and their limits");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitBadInput;
  }

  set_log_quiet(render.quiet || reference.quiet || verify.quiet || merge.quiet || bench.quiet);
  set_thread_count(threads);
  install_interrupt_handler();
  if (render_command) return run_render(render);
  if (reference_command) return run_reference(reference);
  if (verify_command) return run_verify(verify);
  if (compare_command) return run_compare(compare);
  if (bench_command) return run_bench(bench);
  if (merge_command) return run_merge(merge);
  if (info_command) return run_info(info);
  if (devices_command) return run_devices();
  return kExitBadInput;
}

}  // namespace
}  // namespace tachylite

int main(int argc, char** argv) {
  try {
    const int code = tachylite::run(argc, argv);
    if (std::fflush(stdout) == 0) return code;
    fmt::print(stderr, "cannot write to standard output: {}\n", std::strerror(errno));
    return tachylite::kExitFailed;
  } catch (const tachylite::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return tachylite::kExitBadInput;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "out of memory\n");
    return tachylite::kExitFailed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return tachylite::kExitFailed;
  }
}
