#pragma once

// Whether the device and the CPU reference agree on a scene, for scenes by the thousand: few samples first, more only
// where these look suspicious.

#include <string>

#include "stress/scene_text.h"
#include "vulkan/device.h"

namespace tachylite::test {

struct Judgement {
  enum class Verdict {
    kAgree,
    kRefused,  // the scene cannot be read or rendered, with a message that says why
    kDiffer,   // three independent pairs of images, or their auxiliary channels, differ
    kDefect    // values dropped, a validation message, an error, or stages and the fused kernel disagree
  };
  Verdict verdict = Verdict::kAgree;
  std::string message;    // of all but kAgree
  int pairs = 0;          // of images that were compared
  uint64_t samples = 0;   // per pixel, of the last pair
  bool black = false;     // nothing to be seen
  double mean_detectable = 0, block_detectable = 0;  // biases that the first pair shows with probability 0.95

  bool failed() const { return verdict == Verdict::kDiffer || verdict == Verdict::kDefect; }
};

struct JudgeOptions {
  uint64_t samples = 512;  // per pixel, of the first pair; of the second and third four and sixteen times as many
  uint32_t seed = 0;
  bool structures = false;  // also compare stages with the kernel for whole paths, where the scene fits it
};

/// A difference is three independent pairs in a row that z_test (image/z_test.h) tells apart, at levels 1e-2, 1e-2 and
/// 1e-3: false alarms are 1e-7 a scene. The power is that of the first pair: those that follow have more samples.
Judgement judge_scene(vulkan::Device& device, const SceneText& text, const JudgeOptions& options);

}  // namespace tachylite::test
