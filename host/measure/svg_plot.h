#pragma once

#include <string>
#include <vector>

namespace tachylite {

struct PlotPoint {
  double x = 0, y = 0;
  double y_low = 0, y_high = 0;  // interval; both 0: none
  std::string label;             // shown while the pointer is on it
};

struct PlotSeries {
  std::string name;
  std::vector<PlotPoint> points;
  int style = 0;        // the page's colour number
  bool dashed = false;  // a guide: no markers
};

/// Logarithmic in both axes. Points that are not positive and finite are left out.
struct Plot {
  std::string x_label, y_label;
  std::vector<PlotSeries> series;
  int width = 620, height = 380;
};

/// An <svg> element with classes for the page's style sheet; its legend stands above.
std::string svg_plot(const Plot& plot);

/// & < > " as entities.
std::string escape_html(const std::string& text);

}  // namespace tachylite
