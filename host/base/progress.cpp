#include "base/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tachylite {
namespace {

constexpr double kBarInterval = 0.1;         // s
constexpr double kLongestLineInterval = 60;  // s
constexpr int kNarrowestBar = 10, kWidestBar = 40;

int terminal_columns(std::FILE* stream) {
  winsize size{};
  return ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string format_duration(double seconds) {
  if (seconds < 0 || !std::isfinite(seconds)) return "?";
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<uint64_t>(std::llround(std::min(seconds, 1e15)));
  const uint64_t h = whole / 3600, m = whole / 60 % 60, s = whole % 60;
  return h > 0 ? fmt::format("{}:{:02}:{:02}", h, m, s) : fmt::format("{}:{:02}", m, s);
}

std::string format_progress(const ProgressFigures& f) {
  const double fraction = std::min(f.fraction, 1.0);
  std::string text = fraction >= 0 ? fmt::format("{:3.0f} %  ", std::floor(100 * fraction)) : "";
  text += f.target_samples > 0 ? fmt::format("{}/{} samples", f.samples, f.target_samples)
                               : fmt::format("{} samples", f.samples);
  text += fraction > 0 ? fmt::format("  {} left", format_duration(f.seconds * (1 - fraction) / fraction))
                       : fmt::format("  {}", format_duration(f.seconds));
  if (f.mpaths_per_s > 0) text += fmt::format("  {:.3g} Mpaths/s", f.mpaths_per_s);
  if (f.relative_error > 0) text += fmt::format("  error {:.2g} %", 100 * f.relative_error);
  return text;
}

std::string format_progress_bar(const ProgressFigures& f, int columns) {
  std::string text = format_progress(f);
  const int room = columns - static_cast<int>(text.size()) - 3;  // brackets and a blank
  if (f.fraction >= 0 && room >= kNarrowestBar) {
    const int width = std::min(room, kWidestBar);
    const int full = static_cast<int>(std::floor(std::min(f.fraction, 1.0) * width));
    text = fmt::format("[{:-<{}}] {}", std::string(static_cast<size_t>(full), '#'), width, text);
  }
  return text.substr(0, static_cast<size_t>(std::max(columns, 0)));
}

ProgressDisplay::ProgressDisplay(bool quiet, std::FILE* stream)
    : stream_(stream),
      style_(quiet                    ? Style::kSilent
             : isatty(fileno(stream)) ? Style::kBar
                                      : Style::kLines),
      next_(style_ == Style::kLines ? interval_ : 0) {}

void ProgressDisplay::update(const ProgressFigures& figures) {
  if (style_ == Style::kSilent || timer_.seconds() < next_) return;
  if (style_ == Style::kBar) {
    fmt::print(stream_, "\r{}\033[K", format_progress_bar(figures, terminal_columns(stream_) - 1));
    drawn_ = true;
    next_ = timer_.seconds() + kBarInterval;
  } else {
    fmt::print(stream_, "{}\n", format_progress(figures));
    next_ = timer_.seconds() + interval_;
    interval_ = std::min(2 * interval_, kLongestLineInterval);
  }
  std::fflush(stream_);
}

void ProgressDisplay::finish() {
  if (drawn_) {
    fmt::print(stream_, "\r\033[K");
    std::fflush(stream_);
  }
  drawn_ = false;
}

}  // namespace tachylite
