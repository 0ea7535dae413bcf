#pragma once
// Scatter plots, as files and as text of a page.
#include <cstddef>
#include <string>
#include <vector>

namespace voyager::tools {

struct PlotPoint {
  double x = 0, y = 0;
  std::string label;    // beside the point, where no other is in the way; may be empty
  bool marked = false;  // larger, and its label goes before others
};

struct PlotSeries {
  std::string name;  // in the legend; empty: not in it
  std::vector<PlotPoint> points;
  bool joined = false;  // by lines, in their order
};

// Points that are not finite are left out. On a logarithmic axis so are those at or below 0.
struct Plot {
  std::string title, x_label, y_label;
  std::vector<PlotSeries> series;
  bool log_x = false, log_y = false;
  double width = 640, height = 420;  // points
  bool legend_at_bottom = false;     // for what rises to the right
};

// A complete <svg> element; text is drawn as outlines, so that it needs no font. `id` begins the
// ids in it, which must differ from those of all else on a page. Throws Error(internal) where cairo
// does.
std::string plot_svg(const Plot& plot, const std::string& id);
// The same picture at two pixels a point.
void write_plot_png(const std::string& path, const Plot& plot);

}  // namespace voyager::tools
