#include "measure/report_html.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "image/ldr.h"
#include "measure/color_map.h"
#include "measure/contest.h"
#include "measure/page_style.h"
#include "measure/report_plots.h"

namespace tachylite {
namespace {

std::string base64(const std::vector<uint8_t>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t n = std::min<size_t>(3, bytes.size() - i);
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < n ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) text += k <= n ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string interval(const Estimate& e) {
  if (!std::isfinite(e.value)) return "never";
  return fmt::format("{:.3g} <small>{:.3g} – {:.3g}</small>", e.value, e.low, e.high);
}

std::string interval(const TargetTime& t) {
  return interval(t.seconds) + (t.extrapolated ? "<small> extrapolated</small>" : "");
}

std::string card(const std::string& title, const std::string& body, bool wide = false) {
  return fmt::format("<div class=\"card{}\"><h3>{}</h3>{}</div>\n", wide ? " wide" : "", escape_html(title), body);
}

std::string level_table(const SceneMeasurement& scene) {
  std::string rows;
  for (const RendererMeasurement& r : scene.renderers)
    for (const LevelMeasurement& l : r.levels)
      rows += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.3g}</td><td>{:.3g}</td><td>{:.3g}</td>"
                          "<td>{}</td></tr>\n",
                          escape_html(r.name), l.samples, interval(l.rel_mse), interval(l.seconds),
                          l.total_seconds.value, l.render.cpu, l.render.wall, interval(l.efficiency));
  return "<div class=\"scroll\"><table><tr><th></th><th>samples</th><th>relMSE</th><th>seconds</th><th>with start-up</th>"
         "<th>CPU s</th><th>wall s</th><th>efficiency</th></tr>" + rows + "</table></div>";
}

std::string time_table(const SceneMeasurement& scene) {
  std::string head, rows;
  for (double target : kTargetErrors) head += fmt::format("<th>to {:g}</th>", target);
  for (const RendererMeasurement& r : scene.renderers) {
    rows += fmt::format("<tr><td>{}</td><td>{:.2f}</td>", escape_html(r.name), r.exponent);
    for (const TargetTime& t : r.times) rows += fmt::format("<td>{}</td>", interval(t));
    rows += "</tr>\n";
  }
  return "<div class=\"scroll\"><table><tr><th></th><th>exponent</th>" + head + "</tr>" + rows + "</table></div>";
}

std::string ratio_table(const Contest& contest) {
  std::string rows;
  for (const LevelRatio& l : contest.levels)
    rows += fmt::format("<tr><td>at {} samples</td><td class=\"good\">{}</td><td>{}</td><td>{}</td></tr>\n", l.samples,
                        interval(l.efficiency), interval(l.rel_mse), interval(l.seconds));
  for (const TargetTime& t : contest.times)
    rows += fmt::format("<tr><td>to relMSE {:g}</td><td></td><td></td><td>{}</td></tr>\n", t.rel_mse, interval(t));
  return "<div class=\"scroll\"><table><tr><th></th><th>efficiency</th><th>relMSE</th><th>seconds</th></tr>" + rows +
         "</table></div>";
}

std::string bar(const char* kind, const std::string& name, double seconds, double most, const std::string& text) {
  return fmt::format("<div class=\"stage {}\"><b title=\"{}\">{}</b><i style=\"width:{:.2f}%\"></i><span>{}</span></div>\n",
                     kind, escape_html(name), escape_html(name), most > 0 ? 100 * seconds / most : 0, text);
}

std::string stage_bars(const SceneMeasurement& scene) {
  std::string text;
  double sum = 0, most = 0, start_most = 0;
  for (const StageTime& s : scene.stages) sum += s.seconds, most = std::max(most, s.seconds);
  for (const StageTime& s : scene.stages)
    text += bar("", s.name, s.seconds, most, fmt::format("{:.3g} s · {:.1f} %", s.seconds, 100 * s.seconds / sum));
  for (const auto& [name, seconds] : scene.start) start_most = std::max(start_most, seconds);
  if (!scene.start.empty()) text += "<p class=\"part\">until the first sample</p>";
  for (const auto& [name, seconds] : scene.start)
    text += bar("start", name, seconds, start_most, fmt::format("{:.3g} s", seconds));
  return text;
}

std::string pictures(const SceneMeasurement& scene) {
  std::string options, store;
  for (const Picture& p : scene.pictures) {
    options += fmt::format("<option>{}</option>", escape_html(p.name));
    store += fmt::format("{}\"data:image/png;base64,{}\"", store.empty() ? "" : ",", base64(encode_png(p.image)));
  }
  // To begin with: the least samples on the left, the best on the right; or the two renderers at equal samples.
  const bool contest = scene.renderers.size() > 1;
  const size_t last = scene.pictures.size() - 1;
  const auto chosen = [&](size_t wanted) {
    std::string text = options;
    for (size_t i = 0, at = 0; (at = text.find("<option>", at)) != std::string::npos; ++i, at += 8)
      if (i == std::min(wanted, last)) return text.replace(at, 8, "<option selected>");
    return text;
  };
  const size_t own = scene.renderers[0].levels.size() > 1 ? 2 : 1;  // pictures of the first renderer
  return fmt::format(
      "<div class=\"pictures\"><div class=\"choose\"><select aria-label=\"left image\">{}</select>"
      "<select aria-label=\"right image\">{}</select></div>"
      "<div class=\"compare\"><img alt=\"\"><img alt=\"\"></div>"
      "<input type=\"range\" min=\"0\" max=\"100\" step=\"0.1\" value=\"50\" aria-label=\"border of the images\">"
      "<div class=\"scale\">relative error {:g} <i></i> {:g}</div>"
      "<script type=\"application/json\">[{}]</script></div>\n",
      chosen(contest ? own - 1 : 0), chosen(contest ? own : own - 1), kLeastMappedError, kMostMappedError, store);
}

std::string scene_section(const SceneMeasurement& s, const Report& report) {
  std::string html = fmt::format("<section><h2>{}</h2><p class=\"sub\">{} × {} pixels · {} seeds · errors from {}</p>\n",
                                 escape_html(s.name), s.width, s.height, s.seeds, escape_html(s.error_from));
  std::string left = card("Error against time", svg_plot(error_plot(s, report.clock)));
  left += card("Seconds to an error", time_table(s));
  for (size_t i = 1; i < s.renderers.size(); ++i)
    left += card(s.renderers[0].name + " over " + s.renderers[i].name,
                 fmt::format("<p class=\"part\">means differ by at most {:.2f} %</p>",
                             100 * largest_mean_difference(s.renderers[0], s.renderers[i])) +
                     ratio_table(compare_renderers(s.name, s.renderers[0], s.renderers[i])));
  if (!s.stages.empty()) left += card("Where the time goes", stage_bars(s));
  html += "<div class=\"cards\"><div class=\"column\">" + left + "</div>";
  html += card("Images", pictures(s)) + card("All levels", level_table(s), true);
  return html + "</div></section>\n";
}

std::string scaling_section(const ScalingSeries& s) {
  std::string html = fmt::format("<section><h2>{}</h2><p class=\"sub\">{}</p><div class=\"cards\">", escape_html(s.name),
                                 escape_html(s.note));
  for (const Plot& plot : scaling_plots(s)) html += card(plot.y_label, svg_plot(plot));
  std::string head = fmt::format("<th>{}</th>", escape_html(s.x_label)), rows;
  for (const std::string& column : s.columns) head += fmt::format("<th>{}</th>", escape_html(column));
  for (const ScalingPoint& p : s.points) {
    rows += fmt::format("<tr><td>{:g}</td>", p.x);
    for (const std::string& column : s.columns) {
      const auto value = p.values.find(column);
      rows += value == p.values.end() ? std::string("<td></td>") : fmt::format("<td>{:.4g}</td>", value->second);
    }
    rows += "</tr>";
  }
  html += card("Figures", "<div class=\"scroll\"><table><tr>" + head + "</tr>" + rows + "</table></div>", true);
  return html + "</div></section>\n";
}

}  // namespace

std::string report_html(const Report& report) {
  const std::string title = report.scenes.empty() ? "Cost as work grows" : "Error against time";
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
                     "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
                     "<title>Tachylite: " + title + "</title><style>" + std::string(kPlotStyle) + kPageStyle +
                     "</style></head><body><main>\n";
  html += fmt::format("<h1>{}</h1><p class=\"sub\">Tachylite {} on {}, {}</p>\n", title, escape_html(report.version),
                      escape_html(report.device), escape_html(report.driver));
  for (const SceneMeasurement& s : report.scenes) html += scene_section(s, report);
  for (const Contest& c : report.against)
    html += fmt::format("<section><h2>{}: {} over {}</h2>", escape_html(c.scene), c.of, c.to) +
            card("Ratios", ratio_table(c)) + "</section>\n";
  for (const ScalingSeries& s : report.scaling) html += scaling_section(s);
  const std::string clock = report.clock == "CPU"
                                ? fmt::format("CPU seconds of all threads over {} cores, for all renderers alike",
                                              report.cores)
                                : std::string("wall-clock seconds");
  html += fmt::format(
      "<footer>relMSE is the mean over pixels and channels of (I − R)² / (R² + 0.01 mean(R)²); efficiency is 1 / (relMSE × "
      "seconds). Seconds are {}, of rendering alone unless said. Small figures are 95 % confidence intervals: errors by a "
      "bootstrap of the seeds in each block of 16 × 16 pixels, times with Student’s t.</footer>\n",
      clock);
  return html + "</main><script>" + kPageScript + "</script></body></html>\n";
}

}  // namespace tachylite
