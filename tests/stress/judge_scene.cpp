#include "stress/judge_scene.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "image/compare.h"
#include "pack/bake_geometry.h"
#include "reference/reference.h"
#include "stress/compare_aovs.h"
#include "support/render_test.h"

namespace tachylite::test {
namespace {

struct Defect {
  std::string message;
};

class Judge {
 public:
  Judge(vulkan::Device& device, const Scene& scene, const JudgeOptions& options)
      : device_(device), scene_(scene), packed_(pack_scene(scene)), options_(options) {}

  /// First what is cheap.
  void compare_auxiliary_channels(Judgement& judgement) {
    if (scene_.integrator.aovs.empty() && !scene_.integrator.moment) return;
    Scene first_hits = scene_;
    first_hits.integrator.max_depth = 1;
    // Nothing is left to sampling but the pixel, so that moments, too, are those of the scene.
    if (!scene_.media.empty()) first_hits.integrator.moment = false;
    const PackedScene packed = pack_scene(first_hits);
    AovReplicates a, b;
    for (uint32_t attempt = 0; attempt < 3; ++attempt) {
      for (uint32_t i = 0; i < kAovReplicates; ++i) {
        const uint32_t seed = kAovReplicates * (3 * options_.seed + attempt) + i;
        a.at(i) = on_device(packed, kAovSamples, seed, KernelStructure::kStages).to_image();
        b.at(i) = on_reference(first_hits, kAovSamples, seed);
      }
      const std::string difference = compare_aovs(a, b);
      if (difference.empty()) return;
      judgement.message = difference;
    }
    judgement.verdict = Judgement::Verdict::kDiffer;
  }

  void check_both_moments() {
    if (!scene_.integrator.moment) return;
    const std::string device = check_moments([&](uint64_t samples) {
      return on_device(packed_, samples, options_.seed, KernelStructure::kStages);
    });
    if (!device.empty()) throw Defect{device + ", on the device"};
    const std::string reference = check_moments([&](uint64_t samples) {
      return film_of_reference(scene_, samples, options_.seed);
    });
    if (!reference.empty()) throw Defect{reference + ", by the reference"};
  }

  void compare(Judgement& judgement) {
    constexpr double kLevels[] = {1e-2, 1e-2, 1e-3};
    for (uint64_t pair = 0; pair < std::size(kLevels); ++pair) {
      ZTestOptions test;
      test.level = kLevels[pair];
      const uint64_t samples = options_.samples << 2 * pair;
      const auto seed = static_cast<uint32_t>(3 * options_.seed + pair);
      const Image a = on_device(packed_, samples, seed, KernelStructure::kStages).to_image();
      const Image b = on_reference(scene_, samples, seed);
      const Comparison comparison = compare_images(a, b, layer_variance(a, b), test);
      judgement.pairs = static_cast<int>(pair) + 1;
      judgement.samples = samples;
      if (pair == 0) note_power(comparison, judgement);
      if (comparison.agree()) return;
      judgement.message = fmt::format("{} samples\n{}", samples, describe(comparison));
    }
    judgement.verdict = Judgement::Verdict::kDiffer;
  }

  /// The same paths but for rounding: all but a few pixels, where an edge is grazed, are the same.
  void compare_structures() {
    if (!bake_geometry(packed_)) return;
    constexpr uint64_t kSamples = 16;
    const FilmBuffer fused = on_device(packed_, kSamples, options_.seed, KernelStructure::kFused);
    const FilmBuffer stages = on_device(packed_, kSamples, options_.seed, KernelStructure::kStages);
    const int pixels = fused.width() * fused.height();
    int different = 0;
    for (int i = 0; i < pixels; ++i) {
      const glm::dvec3 a = fused.mean(static_cast<size_t>(i)), b = stages.mean(static_cast<size_t>(i));
      different += glm::length(a - b) > 1e-3 * (glm::length(b) + 1e-6);
    }
    if (different > std::max(3, pixels / 20))
      throw Defect{fmt::format("stages and the fused kernel differ in {} of {} pixels", different, pixels)};
  }

 private:
  static constexpr uint64_t kAovSamples = 32;

  FilmBuffer on_device(const PackedScene& packed, uint64_t samples, uint32_t seed, KernelStructure structure) {
    RenderOptions render;
    render.samples = samples;
    render.seed = seed;
    render.structure = structure;
    const size_t messages = device_.validation_messages().size();
    Renderer renderer(device_, packed, render);
    FilmBuffer film = renderer.render();
    const RenderStatistics& statistics = renderer.statistics();
    if (statistics.nonfinite) throw Defect{fmt::format("{} values are not finite", statistics.nonfinite)};
    if (statistics.overflow) throw Defect{fmt::format("{} values dropped for lack of room", statistics.overflow)};
    const std::vector<std::string> all = device_.validation_messages();
    if (all.size() > messages) throw Defect{"validation: " + all.back()};
    return film;
  }

  static Image on_reference(const Scene& scene, uint64_t samples, uint32_t seed) {
    return film_of_reference(scene, samples, seed).to_image();
  }
  static FilmBuffer film_of_reference(const Scene& scene, uint64_t samples, uint32_t seed) {
    ReferenceOptions render;
    render.samples = samples;
    render.seed = seed + 0x40000000u;
    const ReferenceImage image = render_reference(scene, render);
    if (image.nonfinite) throw Defect{fmt::format("{} samples of the reference are not finite", image.nonfinite)};
    return image.film;
  }

  static void note_power(const Comparison& comparison, Judgement& judgement) {
    judgement.black = std::all_of(comparison.channels.begin(), comparison.channels.end(),
                                  [](const ChannelDifference& c) { return c.mean_a == 0 && c.mean_b == 0; });
    if (!comparison.test) return;
    for (const MeanTest& mean : comparison.test->means)
      judgement.mean_detectable = std::max(judgement.mean_detectable, mean.detectable);
    judgement.block_detectable = comparison.test->blocks.detectable;
  }

  vulkan::Device& device_;
  const Scene& scene_;
  PackedScene packed_;
  JudgeOptions options_;
};

}  // namespace

Judgement judge_scene(vulkan::Device& device, const SceneText& text, const JudgeOptions& options) {
  Judgement judgement;
  try {
    const Scene scene = scene_from_elements(text.xml(), text.files);
    Judge judge(device, scene, options);
    judge.check_both_moments();
    judge.compare_auxiliary_channels(judgement);
    if (!judgement.failed()) judge.compare(judgement);
    if (options.structures && !judgement.failed()) judge.compare_structures();
  } catch (const InputError& error) {
    judgement.verdict = Judgement::Verdict::kRefused;
    judgement.message = error.what();
  } catch (const Defect& defect) {
    judgement.verdict = Judgement::Verdict::kDefect;
    judgement.message = defect.message;
  } catch (const std::exception& error) {
    judgement.verdict = Judgement::Verdict::kDefect;
    judgement.message = error.what();
  }
  return judgement;
}

}  // namespace tachylite::test
