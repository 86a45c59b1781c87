#include "measure/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tachylite {
namespace {

constexpr double kLeft = 64, kRight = 20, kTop = 34, kBottom = 48, kLegendLine = 18;

bool drawable(const PlotPoint& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && p.x > 0 && p.y > 0;
}

bool has_interval(const PlotPoint& p) { return p.y_low > 0 && p.y_high > p.y_low; }

/// A logarithmic axis from low to high (decades), drawn from `from` to `to`.
struct Axis {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  double from = 0, to = 1;

  void grow(double value) {
    low = std::min(low, std::log10(value));
    high = std::max(high, std::log10(value));
  }
  /// Some air around the values, and a third of a decade at least.
  void round() {
    if (!(low <= high)) low = 0, high = 1;
    const double air = std::max(0.06 * (high - low), (1.0 / 3 - (high - low)) / 2);
    low -= std::max(air, 0.02);
    high += std::max(air, 0.02);
  }
  double operator()(double value) const { return from + (std::log10(value) - low) / (high - low) * (to - from); }
};

std::string number(double value) {
  if (value >= 1e-3 && value < 1e5) return fmt::format("{:g}", value);
  const int exponent = static_cast<int>(std::floor(std::log10(value) + 1e-9));
  const double mantissa = value / std::pow(10, exponent);
  const std::string power = fmt::format("10<tspan dy=\"-5\" font-size=\"9\">{}</tspan>", exponent);
  return std::abs(mantissa - 1) < 1e-6 ? power : fmt::format("{:g}·{}", mantissa, power);
}

/// 1, 2, 5 of each decade where there are few decades; else powers of ten, every nth.
std::vector<double> ticks(const Axis& axis) {
  const double decades = axis.high - axis.low;
  std::vector<double> values;
  const int step = static_cast<int>(std::ceil(decades / 9));
  for (int e = static_cast<int>(std::floor(axis.low)); e <= axis.high; ++e) {
    if (((e % step) + step) % step != 0) continue;
    for (double m : {1.0, 2.0, 5.0}) {
      if (m > 1 && decades > 2.2) continue;
      const double exponent = e + std::log10(m);
      if (exponent >= axis.low && exponent <= axis.high) values.push_back(m * std::pow(10, e));
    }
  }
  return values;
}

std::string draw_grid(const Axis& x, const Axis& y, const Plot& plot) {
  std::string svg;
  for (double value : ticks(x))
    svg += fmt::format("<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
                       "<text class=\"tick\" x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>\n",
                       x(value), y.to, y.from, y.from + 17, number(value));
  for (double value : ticks(y))
    svg += fmt::format("<line class=\"grid\" x1=\"{1}\" x2=\"{2}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/>"
                       "<text class=\"tick\" x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
                       y(value), x.from, x.to, x.from - 7, y(value) + 4, number(value));
  svg += fmt::format("<text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>", (x.from + x.to) / 2,
                     plot.height - 10, escape_html(plot.x_label));
  svg += fmt::format("<text class=\"label\" transform=\"translate(15 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                     (y.from + y.to) / 2, escape_html(plot.y_label));
  return svg;
}

std::string draw_series(const PlotSeries& series, const Axis& x, const Axis& y) {
  std::string path, marks;
  for (const PlotPoint& p : series.points) {
    if (!drawable(p)) continue;
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x(p.x), y(p.y));
    if (has_interval(p))
      marks += fmt::format("<line class=\"bar\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\"/>", x(p.x),
                           y(p.y_low), y(p.y_high));
    if (!series.dashed)
      marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.6\"><title>{}</title></circle>", x(p.x), y(p.y),
                           escape_html(p.label));
  }
  return fmt::format("<g class=\"series s{}{}\"><path d=\"{}\"/>{}</g>\n", series.style, series.dashed ? " guide" : "",
                     path, marks);
}

/// What the legend is made of; `lines` is set to how many lines it takes.
std::string draw_legend(const Plot& plot, int& lines) {
  std::string svg;
  lines = 1;
  double at = kLeft;
  for (const PlotSeries& series : plot.series) {
    const double width = 44 + 6.6 * static_cast<double>(series.name.size());
    if (at > kLeft && at + width > plot.width) {
      at = kLeft;
      ++lines;
    }
    const double y = 16 + kLegendLine * (lines - 1);
    svg += fmt::format("<g class=\"series s{}{}\"><path d=\"M{:.0f} {:.0f}h22\"/></g><text class=\"key\" x=\"{:.0f}\" "
                       "y=\"{:.0f}\">{}</text>\n",
                       series.style, series.dashed ? " guide" : "", at, y, at + 28, y + 4, escape_html(series.name));
    at += width;
  }
  return svg;
}

}  // namespace

std::string svg_plot(const Plot& plot) {
  Axis x, y;
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& p : series.points) {
      if (!drawable(p)) continue;
      x.grow(p.x);
      y.grow(p.y);
      if (!has_interval(p)) continue;
      y.grow(p.y_low);
      y.grow(p.y_high);
    }
  x.round();
  y.round();
  x.from = kLeft, x.to = plot.width - kRight;
  int legend_lines = 0;
  const std::string legend = draw_legend(plot, legend_lines);
  y.from = plot.height - kBottom, y.to = kTop + kLegendLine * (legend_lines - 1);
  std::string svg = fmt::format("<svg class=\"plot\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
                                "aria-label=\"{2} against {3}\">\n",
                                plot.width, plot.height, escape_html(plot.y_label), escape_html(plot.x_label));
  const std::string clip = fmt::format("clip{}x{}x{}", plot.width, plot.height, legend_lines);
  svg += fmt::format("<clipPath id=\"{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>", clip, kLeft,
                     y.to, x.to - x.from, y.from - y.to);
  svg += draw_grid(x, y, plot) + fmt::format("<g clip-path=\"url(#{})\">\n", clip);
  for (const PlotSeries& series : plot.series) svg += draw_series(series, x, y);
  return svg + "</g>" + legend + "</svg>\n";
}

std::string escape_html(const std::string& text) {
  std::string result;
  for (char c : text) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      default: result += c;
    }
  }
  return result;
}

}  // namespace tachylite
