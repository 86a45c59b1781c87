#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "base/timer.h"

namespace tachylite {

/// How far a render is.
struct ProgressFigures {
  double fraction = 0;                       // of the work, 0..1; negative: unknown
  uint64_t samples = 0, target_samples = 0;  // per pixel; target 0: none
  double seconds = 0;                        // since it began
  double mpaths_per_s = 0;                   // 0: unknown
  double relative_error = 0;                 // of the image's mean pixel; 0: unknown
};

/// "1:02:03", "2:03", "4.5 s".
std::string format_duration(double seconds);

/// Percentage, samples, time left, speed and error, as far as they are known.
std::string format_progress(const ProgressFigures& figures);
/// The same behind a bar that fills what is left of `columns` characters, where there is room for one.
std::string format_progress_bar(const ProgressFigures& figures, int columns);

/// Shows progress on stderr: a bar that is redrawn at most ten times a second on a terminal; elsewhere plain
/// lines after 10, 20, 40, 80 s and then each minute; nothing when quiet. The bar is wiped in the end.
class ProgressDisplay {
 public:
  explicit ProgressDisplay(bool quiet, std::FILE* stream = stderr);
  ~ProgressDisplay() { finish(); }
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void update(const ProgressFigures& figures);
  void finish();

 private:
  enum class Style { kSilent, kBar, kLines };
  std::FILE* stream_;
  Style style_;
  Timer timer_;
  double interval_ = 10;  // of plain lines [s]
  double next_;           // when to show something again [s of timer_]
  bool drawn_ = false;
};

}  // namespace tachylite
