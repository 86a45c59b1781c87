#include "measure/report_text.h"

#include <cmath>

#include <fmt/format.h>

#include "measure/contest.h"

namespace tachylite {
namespace {

std::string describe_levels(const RendererMeasurement& r) {
  std::string text;
  for (const LevelMeasurement& l : r.levels)
    text += fmt::format("  {:<12}{:>7}{:>37}{:>12.4g}{:>12.4g}{:>32}\n", r.name, l.samples, with_interval(l.rel_mse),
                        l.seconds.value, l.total_seconds.value, with_interval(l.efficiency));
  return text;
}

std::string describe_times(const RendererMeasurement& r) {
  std::string text = fmt::format("  {} relMSE ~ seconds^{:.2f}", r.name, r.exponent);
  for (const TargetTime& t : r.times)
    text += fmt::format("; to {:g}: {} s{}", t.rel_mse, with_interval(t.seconds), t.extrapolated ? " (extrapolated)" : "");
  return r.times.empty() ? "" : text + "\n";
}

std::string describe_ratios(const Contest& contest) {
  std::string text;
  for (const LevelRatio& l : contest.levels)
    text += fmt::format("  {:>7} samples: efficiency {}, relMSE {}, seconds {}\n", l.samples, with_interval(l.efficiency),
                        with_interval(l.rel_mse), with_interval(l.seconds));
  for (const TargetTime& t : contest.times)
    text += fmt::format("  time to relMSE {:g}: {}{}\n", t.rel_mse, with_interval(t.seconds),
                        t.extrapolated ? " (extrapolated)" : "");
  return text;
}

}  // namespace

std::string with_interval(const Estimate& e) {
  return fmt::format("{:.4g} ({:.4g} .. {:.4g})", e.value, e.low, e.high);
}

std::string describe(const Report& report) {
  std::string text;
  for (const SceneMeasurement& s : report.scenes) {
    text += fmt::format("{}: {} x {} pixels, {} seeds, errors from {}\n", s.name, s.width, s.height, s.seeds, s.error_from);
    text += fmt::format("  {:<12}{:>7}{:>37}{:>12}{:>12}{:>32}\n", "renderer", "spp", "relMSE", "render [s]", "total [s]",
                        "efficiency");
    for (const RendererMeasurement& r : s.renderers) text += describe_levels(r);
    for (const RendererMeasurement& r : s.renderers) text += describe_times(r);
    for (size_t i = 1; i < s.renderers.size(); ++i) {
      const RendererMeasurement &a = s.renderers[0], &b = s.renderers[i];
      text += fmt::format("  {} / {}: means differ by at most {:.2f} %\n", a.name, b.name,
                          100 * largest_mean_difference(a, b));
      text += describe_ratios(compare_renderers(s.name, a, b));
    }
  }
  for (const ScalingSeries& series : report.scaling) {
    text += fmt::format("{}\n  {:>12}", series.name, series.x_label);
    for (const std::string& column : series.columns) text += fmt::format("{:>26}", column);
    text += "\n";
    for (const ScalingPoint& p : series.points) {
      text += fmt::format("  {:>12g}", p.x);
      for (const std::string& column : series.columns) {
        const auto value = p.values.find(column);
        text += value == p.values.end() ? fmt::format("{:>26}", "-") : fmt::format("{:>26.4g}", value->second);
      }
      text += "\n";
    }
    if (!series.note.empty()) text += fmt::format("  {}\n", series.note);
  }
  for (const Contest& contest : report.against)
    text += fmt::format("{}: {} / {}\n", contest.scene, contest.of, contest.to) + describe_ratios(contest);
  return text;
}

}  // namespace tachylite
