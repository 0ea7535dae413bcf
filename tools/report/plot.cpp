#include "tools/report/plot.h"

#include <cairo-svg.h>
#include <cairo.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "tools/report/label_room.h"
#include "tools/report/plot_axis.h"

namespace voyager::tools {
namespace {

using Rgb = std::array<double, 3>;
// Of Okabe and Ito, told apart by most eyes.
constexpr Rgb kSeries[] = {{0, 0.45, 0.70},    {0.84, 0.37, 0},   {0, 0.62, 0.45},
                           {0.80, 0.47, 0.65}, {0.90, 0.62, 0},   {0.34, 0.71, 0.91},
                           {0.35, 0.35, 0.35}, {0.60, 0.20, 0.20}};
constexpr Rgb kInk{0.13, 0.13, 0.13}, kGrid{0.88, 0.88, 0.88};
constexpr double kLeft = 62, kRight = 18, kTop = 34, kBottom = 48;

using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;
using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

bool can_be_drawn(const Plot& plot, const PlotPoint& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && (!plot.log_x || point.x > 0) &&
         (!plot.log_y || point.y > 0);
}

PlotAxis axis_of(const Plot& plot, double PlotPoint::*value, bool logarithmic) {
  std::vector<double> values;
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& point : series.points)
      if (can_be_drawn(plot, point)) values.push_back(point.*value);
  return PlotAxis(values, logarithmic);
}

class Canvas {
 public:
  Canvas(cairo_t* context, const Plot& plot)
      : c_(context),
        plot_(plot),
        x_(axis_of(plot, &PlotPoint::x, plot.log_x)),
        y_(axis_of(plot, &PlotPoint::y, plot.log_y)) {}

  void draw() {
    cairo_set_source_rgb(c_, 1, 1, 1);
    cairo_paint(c_);
    cairo_select_font_face(c_, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    draw_axes();
    for (size_t i = 0; i < plot_.series.size(); ++i)
      draw_series(plot_.series[i], kSeries[i % std::size(kSeries)]);
    draw_legend();
    draw_labels();
  }

 private:
  double px(double x) const { return kLeft + x * (plot_.width - kLeft - kRight); }
  double py(double y) const { return plot_.height - kBottom - y * (plot_.height - kTop - kBottom); }

  void colour(const Rgb& rgb) { cairo_set_source_rgb(c_, rgb[0], rgb[1], rgb[2]); }

  // align: 0 begins at x, 1 ends there.
  void text(double x, double y, const std::string& of, double size, double align) {
    cairo_set_font_size(c_, size);
    cairo_text_extents_t extents;
    cairo_text_extents(c_, of.c_str(), &extents);
    cairo_move_to(c_, x - align * extents.x_advance, y);
    cairo_show_text(c_, of.c_str());
  }

  void line(double x0, double y0, double x1, double y1) {
    cairo_move_to(c_, x0, y0);
    cairo_line_to(c_, x1, y1);
    cairo_stroke(c_);
  }

  void draw_axes() {
    cairo_set_line_width(c_, 1);
    for (const PlotAxis::Tick& tick : x_.ticks()) {
      colour(kGrid);
      line(px(tick.at), py(0), px(tick.at), py(1));
      colour(kInk);
      text(px(tick.at), py(0) + 15, tick.label, 10, 0.5);
    }
    for (const PlotAxis::Tick& tick : y_.ticks()) {
      colour(kGrid);
      line(px(0), py(tick.at), px(1), py(tick.at));
      colour(kInk);
      text(px(0) - 6, py(tick.at) + 3.5, tick.label, 10, 1);
    }
    colour(kInk);
    line(px(0), py(0), px(1), py(0));
    line(px(0), py(0), px(0), py(1));
    text(px(0), 20, plot_.title, 13, 0);
    text(px(0.5), plot_.height - 12, plot_.x_label, 11, 0.5);
    cairo_save(c_);
    cairo_translate(c_, 14, py(0.5));
    cairo_rotate(c_, -std::numbers::pi / 2);
    text(0, 0, plot_.y_label, 11, 0.5);
    cairo_restore(c_);
  }

  void draw_series(const PlotSeries& series, const Rgb& rgb) {
    colour(rgb);
    cairo_set_line_width(c_, 1.5);
    cairo_new_path(c_);
    for (const PlotPoint& point : series.points)
      if (series.joined && can_be_drawn(plot_, point))
        cairo_line_to(c_, px(x_.at(point.x)), py(y_.at(point.y)));
    cairo_stroke(c_);
    for (const PlotPoint& point : series.points) {
      if (!can_be_drawn(plot_, point)) continue;
      cairo_arc(c_, px(x_.at(point.x)), py(y_.at(point.y)), point.marked ? 4.5 : 3, 0,
                2 * std::numbers::pi);
      cairo_fill(c_);
    }
  }

  // Those of marked points first. One that finds no room above or below its point is left out.
  void draw_labels() {
    colour(kInk);
    for (const bool marked : {true, false})
      for (const PlotSeries& series : plot_.series)
        for (const PlotPoint& point : series.points)
          if (point.marked == marked && !point.label.empty() && can_be_drawn(plot_, point))
            draw_label(point);
  }

  void draw_label(const PlotPoint& point) {
    const double x = px(x_.at(point.x)), y = py(y_.at(point.y));
    const bool beside = x < plot_.width - 150;
    for (const double down : {-5, 11})
      if (text_where_there_is_room(x + (beside ? 6 : -6), y + down, point.label, 9, beside ? 0 : 1))
        return;
  }

  bool text_where_there_is_room(double x, double y, const std::string& of, double size,
                                double align) {
    cairo_set_font_size(c_, size);
    cairo_text_extents_t extents;
    cairo_text_extents(c_, of.c_str(), &extents);
    const double left = x - align * extents.x_advance;
    if (!room_.take({left, y - 0.8 * size, left + extents.x_advance, y + 0.2 * size})) return false;
    text(x, y, of, size, align);
    return true;
  }

  void draw_legend() {
    constexpr double kLine = 14;
    const auto below = static_cast<double>(plot_.series.size());
    double y = plot_.legend_at_bottom ? py(0) - kLine * below : kTop + 4;
    for (size_t i = 0; i < plot_.series.size(); ++i) {
      if (plot_.series[i].name.empty()) continue;
      colour(kSeries[i % std::size(kSeries)]);
      cairo_arc(c_, px(1) - 8, y, 3.5, 0, 2 * std::numbers::pi);
      cairo_fill(c_);
      colour(kInk);
      text_where_there_is_room(px(1) - 16, y + 3.5, plot_.series[i].name, 10, 1);
      y += kLine;
    }
  }

  cairo_t* c_;
  const Plot& plot_;
  PlotAxis x_, y_;
  LabelRoom room_;
};

void require_success(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(ErrorCode::internal, std::string("plot: ") + cairo_status_to_string(status));
}

void draw(cairo_surface_t* surface, const Plot& plot, double scale) {
  const Context context(cairo_create(surface), &cairo_destroy);
  cairo_scale(context.get(), scale, scale);
  Canvas(context.get(), plot).draw();
  require_success(cairo_status(context.get()));
}

cairo_status_t append(void* into, const unsigned char* bytes, unsigned count) {
  try {
    static_cast<std::string*>(into)->append(reinterpret_cast<const char*>(bytes), count);
  } catch (...) {
    return CAIRO_STATUS_NO_MEMORY;
  }
  return CAIRO_STATUS_SUCCESS;
}

// cairo counts its glyphs from 0 in each picture.
void set_ids(std::string& svg, const std::string& id) {
  for (const char* before : {"id=\"", "href=\"#", "url(#"}) {
    const size_t length = std::string(before).size();
    for (size_t at = svg.find(before); at != std::string::npos; at = svg.find(before, at + length))
      svg.insert(at + length, id + "-");
  }
}

}  // namespace

std::string plot_svg(const Plot& plot, const std::string& id) {
  std::string svg;
  const Surface surface(cairo_svg_surface_create_for_stream(append, &svg, plot.width, plot.height),
                        &cairo_surface_destroy);
  draw(surface.get(), plot, 1);
  cairo_surface_finish(surface.get());
  require_success(cairo_surface_status(surface.get()));
  svg.erase(0, svg.find("<svg"));  // what stands before it is a file's
  set_ids(svg, id);
  return svg;
}

void write_plot_png(const std::string& path, const Plot& plot) {
  constexpr double kScale = 2;
  const Surface surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(kScale * plot.width),
                                 static_cast<int>(kScale * plot.height)),
      &cairo_surface_destroy);
  draw(surface.get(), plot, kScale);
  std::string png;
  require_success(cairo_surface_write_to_png_stream(surface.get(), append, &png));
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(png)));
  file.commit();
}

}  // namespace voyager::tools
