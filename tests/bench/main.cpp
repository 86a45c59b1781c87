// tachylite_bench: how fast the kernels are, against a yardstick in the same process.

#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/bounces.h"
#include "bench/build.h"
#include "bench/lights.h"
#include "bench/materials.h"
#include "bench/media.h"
#include "bench/paths.h"
#include "bench/rays.h"
#include "bench/scenes.h"

namespace tachylite::bench {
namespace {

void print_rays(const std::vector<RaysResult>& results, bool json) {
  if (!json) fmt::print("{:8} {:9} {:>9} {:>9} {:>7} {:>10}\n", "scene", "rays", "Mrays/s", "Embree", "ratio", "mismatches");
  for (size_t i = 0; i < results.size(); ++i) {
    const RaysResult& r = results[i];
    if (json)
      fmt::print("{}{{\"scene\": \"{}\", \"rays\": \"{}\", \"mrays\": {:.3f}, \"embree_mrays\": {:.3f}, "
                 "\"ratio\": {:.3f}, \"mismatches\": {}}}{}\n",
                 i == 0 ? "[" : " ", r.scene, r.rays, r.mrays, r.embree_mrays, r.ratio(), r.mismatches,
                 i + 1 < results.size() ? "," : "]");
    else
      fmt::print("{:8} {:9} {:9.2f} {:9.2f} {:7.3f} {:10}\n", r.scene, r.rays, r.mrays, r.embree_mrays, r.ratio(),
                 r.mismatches);
  }
}

void print_bounces(const std::vector<BouncesResult>& results, bool json) {
  if (!json)
    fmt::print("{:8} {:15} {:>9} {:>9} {:>7} {:>9} {:>9}\n", "scene", "rays", "Mrays/s", "Embree", "ratio", "distances",
               "seen");
  for (size_t i = 0; i < results.size(); ++i) {
    const BouncesResult& r = results[i];
    if (json)
      fmt::print("{}{{\"scene\": \"{}\", \"rays\": \"{}\", \"mrays\": {:.3f}, \"embree_mrays\": {:.3f}, "
                 "\"ratio\": {:.3f}, \"distance_ratio\": {:.5f}, \"seen_ratio\": {:.5f}}}{}\n",
                 i == 0 ? "[" : " ", r.scene, r.rays, r.mrays, r.embree_mrays, r.ratio(), r.distance_ratio, r.seen_ratio,
                 i + 1 < results.size() ? "," : "]");
    else
      fmt::print("{:8} {:15} {:9.2f} {:9.2f} {:7.3f} {:9.5f} {:9.5f}\n", r.scene, r.rays, r.mrays, r.embree_mrays,
                 r.ratio(), r.distance_ratio, r.seen_ratio);
  }
}

void print_build(const std::vector<BuildResult>& results, bool json) {
  for (size_t i = 0; i < results.size(); ++i) {
    const BuildResult& r = results[i];
    if (json)
      fmt::print("{}{{\"mesh\": \"{}\", \"triangles\": {}, \"cpu\": {:.4f}, \"wall\": {:.4f}, \"embree_medium_cpu\": {:.4f}, "
                 "\"embree_medium_wall\": {:.4f}, \"embree_high_cpu\": {:.4f}, \"embree_high_wall\": {:.4f}, "
                 "\"pair\": {:.4f}, \"tree\": {:.4f}, \"optimise\": {:.4f}, \"flatten\": {:.4f}, \"sah_cost\": {:.2f}}}{}\n",
                 i == 0 ? "[" : " ", r.mesh, r.triangles, r.ours.cpu, r.ours.wall, r.medium.cpu, r.medium.wall, r.high.cpu,
                 r.high.wall, r.pair, r.tree, r.optimise, r.flatten, r.sah_cost, i + 1 < results.size() ? "," : "]");
    else
      fmt::print("{}, {} triangles: CPU (wall) seconds {:.3f} ({:.3f}), Embree medium {:.3f} ({:.3f}), high {:.3f} ({:.3f}); "
                 "CPU ratio {:.2f} to medium, {:.2f} to high\n  wall: pairs {:.3f}, tree {:.3f}, reinsertion {:.3f}, "
                 "flattening {:.3f}; SAH cost {:.2f}\n",
                 r.mesh, r.triangles, r.ours.cpu, r.ours.wall, r.medium.cpu, r.medium.wall, r.high.cpu, r.high.wall,
                 r.ours.cpu / r.medium.cpu, r.ours.cpu / r.high.cpu, r.pair, r.tree, r.optimise, r.flatten, r.sah_cost);
  }
}

void print_paths(const PathsResult& r, bool json) {
  if (json)
    fmt::print("{{\"mpaths\": {:.3f}, \"embree_mpaths\": {:.3f}, \"ratio\": {:.3f}, \"mrays\": {:.1f}, \"mean_ratio\": {:.4f}}}\n",
               r.mpaths, r.embree_mpaths, r.ratio(), r.mrays, r.mean_ratio);
  else
    fmt::print("Mpaths/s {:.2f}, Embree {:.2f}, ratio {:.3f}; {:.1f} Mrays/s; ratio of the images' means {:.4f}\n", r.mpaths,
               r.embree_mpaths, r.ratio(), r.mrays, r.mean_ratio);
}

void print_ray_share(const RayShareResult& r, bool json) {
  if (json)
    fmt::print("{{\"mpaths\": {:.3f}, \"mpaths_of_rays\": {:.3f}, \"ratio\": {:.3f}}}\n", r.mpaths, r.mpaths_of_rays(),
               r.share);
  else
    fmt::print("Mpaths/s {:.2f}, its rays alone {:.2f}, ratio {:.3f}\n", r.mpaths, r.mpaths_of_rays(), r.share);
  if (json) return;
  for (const auto& [kernel, share] : r.kernels) fmt::print("  {:24} {:5.1f} %\n", kernel, 100 * share);
}

void print_media(const std::vector<MediumGain>& gains, const std::vector<MediumCost>& costs) {
  for (const MediumGain& g : gains)
    fmt::print("{:38} relMSE {:9.3g}, yardstick {:9.3g}: {:6.1f} times lower; largest pixel {:.1f} against {:.1f} means, "
               "CPU time {:.2f}, means {:.4f}\n",
               g.scene, g.ours, g.yardstick, g.yardstick / g.ours, g.ours_largest, g.yardstick_largest, g.seconds_ratio,
               g.mean_ratio);
  for (const MediumCost& c : costs) fmt::print("{:32} {:8.1f} ns a collision\n", c.kernel, c.ns_per_event);
}

void print_lights(const std::vector<LightsResult>& results, bool json) {
  if (!json) fmt::print("{:>8} {:>9} {:>12} {:>9} {:>12} {:>6}\n", "lights", "ns/path", "uniform", "variance", "uniform", "gain");
  for (size_t i = 0; i < results.size(); ++i) {
    const LightsResult& r = results[i];
    if (json)
      fmt::print("{}{{\"lights\": {}, \"ns_per_path\": {:.1f}, \"uniform_ns_per_path\": {:.1f}, \"relative_variance\": "
                 "{:.4g}, \"uniform_variance\": {:.4g}, \"equal_time_gain\": {:.2f}}}{}\n",
                 i == 0 ? "[" : " ", r.lights, r.ns_per_path, r.uniform_ns_per_path, r.relative_variance,
                 r.uniform_variance, r.equal_time_gain(), i + 1 < results.size() ? "," : "]");
    else
      fmt::print("{:8} {:9.0f} {:12.0f} {:9.3g} {:12.3g} {:6.1f}\n", r.lights, r.ns_per_path, r.uniform_ns_per_path,
                 r.relative_variance, r.uniform_variance, r.equal_time_gain());
  }
}

void print_sun(const std::vector<SunResult>& results, bool json) {
  for (size_t i = 0; i < results.size(); ++i) {
    const SunResult& r = results[i];
    if (json)
      fmt::print("{}{{\"sampling\": \"{}\", \"relative_variance\": {:.4g}, \"ns_per_path\": {:.1f}}}{}\n",
                 i == 0 ? "[" : " ", r.sampling, r.relative_variance, r.ns_per_path, i + 1 < results.size() ? "," : "]");
    else
      fmt::print("{:8} relative variance {:9.3g}, {:5.0f} ns/path\n", r.sampling, r.relative_variance, r.ns_per_path);
  }
}

void print_materials(const MaterialsResult& r, bool json) {
  const auto print = [&](const MaterialResult& m) {
    if (json)
      fmt::print("{}{{\"name\": \"{}\", \"shade_ns\": {:.1f}, \"total_ns\": {:.1f}}}", &m == &r.single.front() ? "  " : ",\n  ",
                 m.name, m.shade_ns, m.total_ns);
    else
      fmt::print("{:28} {:10.1f} {:10.1f}\n", m.name, m.shade_ns, m.total_ns);
  };
  if (json) fmt::print("{{\"materials\": [\n");
  else fmt::print("{:28} {:>10} {:>10}\n", "material", "shading ns", "all ns");
  for (const MaterialResult& m : r.single) print(m);
  print(r.parts);
  print(r.mixed);
  const double ratio = r.mixed.total_ns / r.parts.total_ns;
  if (json) fmt::print("], \"mixed_over_parts\": {:.3f}}}\n", ratio);
  else fmt::print("eight side by side over the mean of the eight alone: {:.3f}\n", ratio);
}

int run(int argc, char** argv) {
  CLI::App app("Benchmarks of Tachylite's kernels");
  app.require_subcommand(1);
  bool json = false;

  CLI::App* rays = app.add_subcommand("rays", "rays per second against Embree's rtcIntersect1 and rtcOccluded1");
  std::string scene;
  int repetitions = 9;
  rays->add_option("--scene", scene, "one scene only")->check(CLI::IsMember(scene_names()));
  rays->add_option("--repetitions", repetitions, "of each measurement, in turn")->check(CLI::Range(1, 1000));
  bool baked = false;
  rays->add_flag("--baked", baked, "tiny scenes by their baked primitives");
  rays->add_flag("--json", json);

  CLI::App* bounces = app.add_subcommand("bounces", "the same of rays made where they are traced, in tiny scenes");
  std::string bounces_scene;
  int bounces_repetitions = 5;
  bounces->add_option("--scene", bounces_scene, "one scene only")->check(CLI::IsMember(tiny_scene_names()));
  bounces->add_option("--repetitions", bounces_repetitions, "of each measurement, in turn")->check(CLI::Range(1, 1000));
  bounces->add_flag("--json", json);

  CLI::App* paths = app.add_subcommand("paths", "paths per second of a Cornell box against a path tracer with Embree");
  int paths_repetitions = 3;
  paths->add_option("--repetitions", paths_repetitions, "of each measurement, in turn")->check(CLI::Range(1, 1000));
  std::string paths_scene;
  paths->add_option("--scene", paths_scene, "of this scene instead, against its rays alone")
      ->check(CLI::IsMember(scene_names()));
  paths->add_flag("--json", json);

  CLI::App* build = app.add_subcommand("build", "seconds to build the tree, against Embree's rtcCommitScene");
  std::string build_mesh;
  int build_repetitions = 3;
  build->add_option("--mesh", build_mesh, "one mesh only")->check(CLI::IsMember(build_mesh_names()));
  build->add_option("--repetitions", build_repetitions, "of each measurement, in turn")->check(CLI::Range(1, 1000));
  build->add_flag("--json", json);

  CLI::App* media = app.add_subcommand("media", "gain of sampling in media, and the cost of a collision");
  int replicates = 8;
  media->add_option("--replicates", replicates, "independent renders of each")->check(CLI::Range(2, 1000));
  CLI::App* lights = app.add_subcommand("lights", "direct light of 1 to 1,000,000 emissive triangles, and of a small sun");
  bool large = false, sun = false;
  int lights_repetitions = 8;
  lights->add_flag("--large", large, "a million, too");
  lights->add_flag("--sun", sun, "an environment with a small sun instead");
  lights->add_option("--repetitions", lights_repetitions, "renders of each measurement")->check(CLI::Range(2, 1000));
  lights->add_flag("--json", json);

  CLI::App* materials = app.add_subcommand("materials", "CPU time of shading a vertex, by material");
  int materials_repetitions = 5;
  materials->add_option("--repetitions", materials_repetitions, "of each measurement")->check(CLI::Range(1, 1000));
  materials->add_flag("--json", json);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (rays->parsed()) print_rays(baked ? bench_baked_rays(scene, repetitions) : bench_rays(scene, repetitions), json);
  if (bounces->parsed()) print_bounces(bench_bounces(bounces_scene, bounces_repetitions), json);
  if (paths->parsed() && !paths_scene.empty()) print_ray_share(bench_ray_share(paths_scene, paths_repetitions), json);
  if (paths->parsed() && paths_scene.empty()) print_paths(bench_paths(paths_repetitions), json);
  if (build->parsed()) print_build(bench_build(build_mesh, build_repetitions), json);
  if (media->parsed()) print_media(bench_medium_gains(replicates), bench_medium_costs());
  if (lights->parsed() && sun) print_sun(bench_sun(lights_repetitions), json);
  if (lights->parsed() && !sun) print_lights(bench_lights(large, lights_repetitions), json);
  if (materials->parsed()) print_materials(bench_materials(materials_repetitions), json);
  return 0;
}

}  // namespace
}  // namespace tachylite::bench

int main(int argc, char** argv) {
  try {
    return tachylite::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
