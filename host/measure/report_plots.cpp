#include "measure/report_plots.h"

#include <algorithm>

#include <fmt/format.h>

#include "measure/page_style.h"

namespace tachylite {
namespace {

constexpr int kStyles = 6, kGuideStyle = 6;

/// What a column's unit measures.
std::string quantity_of(const std::string& unit) {
  return unit == "s" ? "seconds" : unit == "MiB" ? "memory [MiB]" : "relMSE";
}

}  // namespace

Plot error_plot(const SceneMeasurement& scene, const std::string& clock) {
  Plot plot;
  plot.x_label = fmt::format("seconds of rendering ({} clock)", clock);
  plot.y_label = "relMSE";
  for (size_t i = 0; i < scene.renderers.size(); ++i) {
    PlotSeries series{scene.renderers[i].name, {}, static_cast<int>(i) % kStyles, false};
    for (const LevelMeasurement& l : scene.renderers[i].levels)
      series.points.push_back(
          {l.seconds.value, l.rel_mse.value, l.rel_mse.low, l.rel_mse.high,
           fmt::format("{}: {} samples, {:.3g} s, relMSE {:.3g}", scene.renderers[i].name, l.samples, l.seconds.value,
                       l.rel_mse.value)});
    plot.series.push_back(series);
  }
  // What independent samples would do from Tachylite's first level on.
  const std::vector<LevelMeasurement>& levels = scene.renderers[0].levels;
  const LevelMeasurement &first = levels.front(), &last = levels.back();
  const double end = first.rel_mse.value * first.seconds.value / last.seconds.value;
  plot.series.push_back({"1 / seconds",
                         {{first.seconds.value, first.rel_mse.value, 0, 0, ""}, {last.seconds.value, end, 0, 0, ""}},
                         kGuideStyle,
                         true});
  return plot;
}

std::vector<Plot> scaling_plots(const ScalingSeries& s) {
  // One plot a unit: seconds, bytes, ...
  std::vector<std::string> units;
  const auto unit_of = [](const std::string& column) {
    const size_t bracket = column.find('[');
    return bracket == std::string::npos ? std::string() : column.substr(bracket + 1, column.find(']') - bracket - 1);
  };
  for (const std::string& column : s.columns)
    if (std::find(units.begin(), units.end(), unit_of(column)) == units.end()) units.push_back(unit_of(column));
  std::vector<Plot> plots;
  for (const std::string& unit : units) {
    Plot plot;
    plot.x_label = s.x_label;
    plot.y_label = quantity_of(unit);
    for (const std::string& column : s.columns) {
      if (unit_of(column) != unit) continue;
      PlotSeries series{column.substr(0, column.find(" [")), {}, static_cast<int>(plot.series.size()) % kStyles, false};
      for (const ScalingPoint& p : s.points)
        if (const auto value = p.values.find(column); value != p.values.end())
          series.points.push_back({p.x, value->second, 0, 0, fmt::format("{:g}: {:.4g} {}", p.x, value->second, unit)});
      plot.series.push_back(series);
    }
    plots.push_back(plot);
  }
  return plots;
}

std::string report_svg(const Report& report) {
  constexpr int kColumns = 2, kGap = 24, kTitle = 26;
  std::string svg;
  int x = kGap, y = kGap, right = 0, bottom = 0;
  const auto add = [&](const std::string& title, const Plot& plot) {
    svg += fmt::format("<g transform=\"translate({} {})\"><text class=\"title\" y=\"14\">{}</text>"
                       "<g transform=\"translate(0 {})\">\n{}</g></g>\n",
                       x, y, escape_html(title), kTitle, svg_plot(plot));
    right = std::max(right, x + plot.width + kGap);
    bottom = y + plot.height + kTitle + kGap;
    x += plot.width + kGap;
    if (x < kGap + kColumns * (plot.width + kGap)) return;
    x = kGap;
    y = bottom;
  };
  for (const SceneMeasurement& scene : report.scenes) add(scene.name, error_plot(scene, report.clock));
  for (const ScalingSeries& series : report.scaling)
    for (const Plot& plot : scaling_plots(series)) add(plot.y_label + " against " + plot.x_label, plot);
  return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">"
                     "<style>{2}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"var(--card)\"/>\n{3}</svg>\n",
                     right, bottom, kPlotStyle, svg);
}

}  // namespace tachylite
