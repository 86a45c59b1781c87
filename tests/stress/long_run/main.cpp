// tachylite_stress: random scenes (stress/random_scene.h), each rendered on the device and by the reference. Prints a
// line a scene; those that fail are minimised and saved. The driver is that of the environment (VK_DRIVER_FILES).

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>

#include <CLI/CLI.hpp>

#include "base/log.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "stress/judge_scene.h"
#include "stress/long_run/pipeline_cache.h"
#include "stress/minimise_scene.h"
#include "stress/random_scene.h"

namespace tachylite::test {
namespace {

struct Arguments {
  uint64_t seed = 0, scenes = 100, samples = 512;
  double hours = 0;
  int threads = 0;
  std::filesystem::path save = "failed";
  bool minimise = true, print = false;
};

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void save(const SceneText& scene, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const auto& [name, content] : scene.files) std::ofstream(folder / name, std::ios::binary) << content;
  std::ofstream(folder / "scene.xml") << "<scene version=\"3.0.0\">\n" << scene.xml() << "</scene>\n";
}

class LongRun {
 public:
  explicit LongRun(const Arguments& arguments) : arguments_(arguments) {}

  int run() {
    const Timer timer;
    keep_pipelines();
    for (uint64_t i = 0; arguments_.hours > 0 ? timer.seconds() < 3600 * arguments_.hours : i < arguments_.scenes; ++i) {
      if ((arguments_.seed + i) % kScenesOfTheme == 0) forget_pipelines();
      judge(arguments_.seed + i);
    }
    forget_pipelines();
    summarize();
    return failed_ == 0 ? 0 : 1;
  }

 private:
  void judge(uint64_t seed) {
    const double begin = cpu_seconds();
    const SceneText scene = random_scene(seed);
    JudgeOptions options;
    options.samples = arguments_.samples;
    options.seed = static_cast<uint32_t>(seed);
    options.structures = seed % 4 == 0;
    fmt::print("{} ", seed);
    std::fflush(stdout);
    vulkan::Device& device = seed % 8 == 0 ? validated_ : plain_;  // validation takes a third of the time
    const Judgement judgement = judge_scene(device, scene, options);
    constexpr const char* kNames[] = {"agree", "refused", "DIFFER", "DEFECT"};
    fmt::print("{} pairs {} mean {:.4f} block {:.4f}{} cpu {:.2f}", kNames[static_cast<int>(judgement.verdict)],
               judgement.pairs, judgement.mean_detectable, judgement.block_detectable, judgement.black ? " black" : "",
               cpu_seconds() - begin);
    std::string first_line = judgement.message.substr(0, judgement.message.find('\n'));
    fmt::print("{}{}\n", first_line.empty() ? "" : " : ", first_line);
    count(judgement);
    if (judgement.failed()) {
      fmt::print("{}\n", judgement.message);
      const auto folder = arguments_.save / fmt::format("seed-{}", seed);
      save(scene, folder);
      std::fflush(stdout);
      if (!arguments_.minimise) return;
      const SceneText least = minimise_scene(scene, [&](const SceneText& candidate) {
        return judge_scene(device, candidate, options).verdict == judgement.verdict;
      });
      save(least, folder / "minimised");
    }
    std::fflush(stdout);
  }

  void count(const Judgement& judgement) {
    ++scenes_;
    failed_ += judgement.failed();
    refused_ += judgement.verdict == Judgement::Verdict::kRefused;
    black_ += judgement.black;
    cleared_ += judgement.verdict == Judgement::Verdict::kAgree && judgement.pairs > 1;
    if (judgement.verdict != Judgement::Verdict::kAgree || judgement.black) return;
    means_.push_back(judgement.mean_detectable);
    blocks_.push_back(judgement.block_detectable);
  }

  void summarize() {
    const auto quantile = [](std::vector<double> values, double q) {
      if (values.empty()) return 0.0;
      std::sort(values.begin(), values.end());
      return values[static_cast<size_t>(q * static_cast<double>(values.size() - 1))];
    };
    fmt::print(
        "{} scenes: {} failed, {} refused, {} black, {} cleared by more samples; a bias seen with probability 0.95, "
        "median and 9th decile: mean {:.1f} % {:.1f} %, median block {:.1f} % {:.1f} %; {:.0f} CPU seconds\n",
        scenes_, failed_, refused_, black_, cleared_, 100 * quantile(means_, 0.5), 100 * quantile(means_, 0.9),
        100 * quantile(blocks_, 0.5), 100 * quantile(blocks_, 0.9), cpu_seconds());
  }

  Arguments arguments_;
  vulkan::Device validated_{{.validation = true}}, plain_;
  uint64_t scenes_ = 0, failed_ = 0, refused_ = 0, black_ = 0, cleared_ = 0;
  std::vector<double> means_, blocks_;
};

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Random scenes on the device against the reference"};
  app.add_option("--seed", arguments.seed, "of the first scene");
  app.add_option("--scenes", arguments.scenes, "how many");
  app.add_option("--hours", arguments.hours, "run that long instead");
  app.add_option("--spp", arguments.samples, "of the first pair of images of a scene");
  app.add_option("--threads", arguments.threads, "of reference and lavapipe; 0: one per core");
  app.add_option("--save", arguments.save, "folder for scenes that fail");
  app.add_flag("!--no-minimise", arguments.minimise, "save them as they are");
  app.add_flag("--print", arguments.print, "print the first scene and its files' names, render nothing");
  CLI11_PARSE(app, argc, argv);
  if (arguments.print) {
    const SceneText scene = random_scene(arguments.seed);
    fmt::print("{}", scene.xml());
    return 0;
  }
  set_log_quiet(true);
  set_thread_count(arguments.threads);
  if (arguments.threads > 0) setenv("LP_NUM_THREADS", std::to_string(arguments.threads).c_str(), 0);
  return LongRun(arguments).run();
}

}  // namespace
}  // namespace tachylite::test

int main(int argc, char** argv) { return tachylite::test::run(argc, argv); }
