#include "command_verify.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "command_device.h"
#include "command_interrupt.h"
#include "image/verify.h"
#include "reference/reference.h"

namespace tachylite {
namespace {

/// The two renderers as verify() wants them: rounds of independent samples of one scene.
class Verifier {
 public:
  Verifier(const VerifyArguments& arguments, const Scene& scene, vulkan::Device& device)
      : arguments_(arguments),
        scene_(scene),
        device_(device),
        packed_(pack_scene(scene, arguments.scene.sensor)),
        seed_(arguments.seed.value_or(scene.sensors[static_cast<size_t>(arguments.scene.sensor)].seed)) {}

  std::optional<Image> render_device(uint64_t samples, int round) {
    RenderOptions options;
    options.samples = samples;
    options.seed = seed_ + static_cast<uint32_t>(round);
    options.sampler = arguments_.sampler;
    options.guiding = arguments_.guiding;
    options.max_paths = arguments_.max_paths;
    options.progress = [&](const RenderProgress& progress) {
      show(progress.fraction, progress.samples, samples);
      return !stopped();
    };
    Renderer renderer(device_, packed_, options);
    const FilmBuffer film = renderer.render();
    check_validation(device_.validation_messages());
    const RenderStatistics& statistics = renderer.statistics();
    if (statistics.nonfinite + statistics.overflow > 0)
      throw RenderError(
          fmt::format("the device dropped {} contributions that were not finite, and {} for lack of room",
                      statistics.nonfinite, statistics.overflow));
    return film.samples() == samples ? std::optional(film.to_image()) : std::nullopt;
  }

  std::optional<Image> render_judge(uint64_t samples, int round) {
    ReferenceOptions options;
    options.sensor = arguments_.scene.sensor;
    options.samples = samples;
    options.seed = seed_ + static_cast<uint32_t>(round);
    options.progress = [&](const ReferenceProgress& progress) {
      show(static_cast<double>(progress.samples_done) / static_cast<double>(samples), progress.samples_done,
           samples);
      return !stopped();
    };
    const ReferenceImage image = render_reference(scene_, options);
    if (image.nonfinite > 0)
      throw RenderError(
          fmt::format("the reference dropped {} samples that were not finite", image.nonfinite));
    return image.samples == samples ? std::optional(to_image(image)) : std::nullopt;
  }

  bool interrupted() const { return interrupt_.requested(); }

 private:
  bool stopped() const {
    return interrupted() || (arguments_.time > 0 && timer_.seconds() > arguments_.time);
  }
  void show(double fraction, uint64_t samples, uint64_t target) {
    display_.update({fraction, samples, target, timer_.seconds(), 0, 0});
  }

  const VerifyArguments& arguments_;
  const Scene& scene_;
  vulkan::Device& device_;
  PackedScene packed_;
  uint32_t seed_;
  Timer timer_;
  InterruptScope interrupt_;
  ProgressDisplay display_{arguments_.quiet};
};

}  // namespace

int run_verify(const VerifyArguments& arguments) {
  const Scene scene = load_scene_of(arguments.scene);
  vulkan::Device device(device_options(arguments.device));
  log_info(fmt::format("{}; {} against the CPU reference", summarize(scene, arguments.scene.sensor),
                       describe(device.info())));
  Verifier verifier(arguments, scene, device);
  const Verification result = verify(
      [&](uint64_t samples, int round) { return verifier.render_device(samples, round); },
      [&](uint64_t samples, int round) { return verifier.render_judge(samples, round); }, {},
      [](const Verification& now) {
        double mean = 0;
        for (const MeanTest& m : now.comparison.test->means) mean = std::max(mean, m.detectable);
        log_info(fmt::format("{} samples{}: would see a bias of {:.2f} % of the mean, {:.1f} % of a block",
                             now.samples, now.confirmed ? ", second pair" : "", 100 * mean,
                             100 * now.comparison.test->blocks.detectable));
      });
  if (verifier.interrupted()) return kExitInterrupted;
  if (result.verdict == Verification::Verdict::kOpen) {
    log_info(fmt::format("no verdict: {} samples do not suffice", result.samples));
    return 1;
  }
  fmt::print("A: device, B: reference, {} samples each{}\n{}", result.samples,
             result.confirmed ? ", the second pair" : "", describe(result.comparison));
  return result.verdict == Verification::Verdict::kAgree ? 0 : 1;
}

}  // namespace tachylite
