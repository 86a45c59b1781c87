#include "measure/contest.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace tachylite {

std::vector<LevelRatio> level_ratios(const RendererMeasurement& a, const RendererMeasurement& b) {
  std::vector<LevelRatio> ratios;
  for (const LevelMeasurement& la : a.levels)
    for (const LevelMeasurement& lb : b.levels)
      if (la.samples == lb.samples)
        ratios.push_back({la.samples, ratio(la.rel_mse, lb.rel_mse), ratio(la.seconds, lb.seconds),
                          ratio(la.efficiency, lb.efficiency)});
  return ratios;
}

std::vector<TargetTime> time_ratios(const RendererMeasurement& a, const RendererMeasurement& b) {
  std::vector<TargetTime> ratios;
  for (const TargetTime& ta : a.times)
    for (const TargetTime& tb : b.times)
      if (ta.rel_mse == tb.rel_mse && std::isfinite(ta.seconds.value) && std::isfinite(tb.seconds.value))
        ratios.push_back({ta.rel_mse, ratio(ta.seconds, tb.seconds), ta.extrapolated || tb.extrapolated});
  return ratios;
}

Contest compare_renderers(const std::string& scene, const RendererMeasurement& a, const RendererMeasurement& b) {
  return {scene, a.name, b.name, level_ratios(a, b), time_ratios(a, b)};
}

std::vector<Contest> compare_reports(const Report& now, const Report& baseline) {
  if (now.clock != baseline.clock)
    throw InputError(fmt::format("--against: the baseline was measured with the clock {}, this run with {}",
                                 baseline.clock, now.clock));
  std::vector<Contest> contests;
  for (const SceneMeasurement& a : now.scenes)
    for (const SceneMeasurement& b : baseline.scenes) {
      if (a.name != b.name || a.width != b.width || a.height != b.height || b.renderers.empty()) continue;
      contests.push_back(compare_renderers(a.name, a.renderers[0], b.renderers[0]));
      contests.back().of = "now";
      contests.back().to = "baseline";
    }
  if (contests.empty()) throw InputError("--against: the baseline has no scene of this run in the same size");
  return contests;
}

double largest_mean_difference(const RendererMeasurement& a, const RendererMeasurement& b) {
  double largest = 0;
  for (size_t c = 0; c < 3; ++c)
    if (b.mean[c] != 0) largest = std::max(largest, std::abs(a.mean[c] / b.mean[c] - 1));
  return largest;
}

}  // namespace tachylite
