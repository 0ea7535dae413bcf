#include "tools/report/curve_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "tools/report/curve_text.h"

namespace voyager::tools {
namespace {

struct Axis {
  const char* label;
  std::optional<double> (*of)(const CurveRow& row);
};

const Axis kShare{"cut, % of the leaves",
                  [](const CurveRow& row) -> std::optional<double> { return 100 * row.cut_share; }};
const Axis kSplats{"splats that reach a pixel",
                   [](const CurveRow& row) -> std::optional<double> { return row.splats; }};
const Axis kTime{"ms a frame, median",
                 [](const CurveRow& row) -> std::optional<double> { return row.milliseconds; }};
const Axis kPsnr{"PSNR against the truth, dB",
                 [](const CurveRow& row) -> std::optional<double> { return row.error.psnr; }};
const Axis kSsim{"SSIM against the truth",
                 [](const CurveRow& row) -> std::optional<double> { return row.error.ssim; }};
const Axis kFlip{"FLIP against the truth",
                 [](const CurveRow& row) -> std::optional<double> { return row.error.flip; }};

// The points carry their shares where the axis has none.
PlotSeries series_of(const std::string& tree, const std::vector<CurveRow>& rows, const Axis& x,
                     const Axis& y) {
  PlotSeries series{tree, {}, true};
  for (const CurveRow& row : rows) {
    const std::optional<double> at = x.of(row), value = y.of(row);
    if (at && value)
      series.points.push_back({*at, *value, &x == &kShare ? "" : share_text(row.share), false});
  }
  return series;
}

// Of each tree's means over the views.
Plot plot_of_means(const std::string& title, const std::vector<Curve>& curves, const Axis& x,
                   const Axis& y) {
  Plot plot{title, x.label, y.label, {}, false, false, 560, 400, &y != &kFlip};
  for (const Curve& curve : curves) plot.series.push_back(series_of(curve.tree, curve.means, x, y));
  return plot;
}

std::string row_cells(const CurveRow& row) {
  const std::string cells[] = {row.view,
                               share_text(row.share),
                               fmt::format("{:.2f} %", 100 * row.cut_share),
                               fmt::format("{:.4g}", row.tau),
                               fmt::format("{:.0f}", row.cut),
                               fmt::format("{:.0f}", row.splats),
                               fmt::format("{:.0f}", row.pairs),
                               decibels(row.error.psnr),
                               fixed(row.error.ssim, 4),
                               fmt::format("{:.4f}", row.error.flip),
                               fixed(row.error.popping, 3),
                               fmt::format("{:.3f}", row.milliseconds)};
  std::string text;
  for (const std::string& cell : cells) text += "<td>" + cell + "</td>";
  return text;
}

std::string rows_table(const std::vector<CurveRow>& rows) {
  std::string text =
      "<div class=\"wide\"><table><tr><th>tree</th><th>view</th><th>share</th><th>the cut's</th>"
      "<th>τ</th><th>cut</th><th>splats</th><th>pairs</th><th>PSNR, dB</th><th>SSIM</th>"
      "<th>FLIP</th><th>popping, 1/255</th><th>ms</th></tr>\n";
  for (const CurveRow& row : rows)
    text += fmt::format("<tr><td>{}</td>{}</tr>\n", escaped(row.tree), row_cells(row));
  return text + "</table></div>\n";
}

std::string means_table(const std::vector<Curve>& curves) {
  std::string text = "<div class=\"wide\"><table><tr><th>mean PSNR, dB, of cuts of</th>";
  for (const double share : kCurveShares) text += "<th>" + share_text(share) + "</th>";
  text += "</tr>\n";
  bool star = false;
  for (const CurveLine& line : curve_lines(curves)) {
    text += "<tr><td>" + escaped(line.name) + "</td>";
    for (const std::string& cell : line.cells) {
      text += "<td>" + cell + "</td>";
      star |= cell.ends_with('*');
    }
    text += "</tr>\n";
  }
  return text + "</table></div>\n" + (star ? fmt::format("<p>{}</p>\n", kStarText) : "");
}

// Nothing where all is well.
std::string warning(const std::vector<CurveRow>& rows) {
  const auto wrong = std::count_if(rows.begin(), rows.end(),
                                   [](const CurveRow& row) { return row.error.not_finite > 0; });
  if (wrong == 0) return "";
  return fmt::format(
      "<p class=\"wrong\">{} rows have pixels that are not finite: see curve.csv.</p>\n", wrong);
}

}  // namespace

std::vector<PagePlot> curve_plots(const std::vector<CurveRow>& rows,
                                  const std::vector<Curve>& curves) {
  const std::string first = rows[0].view;
  Plot of_first = plot_of_means("Quality over cut size: view " + first, {}, kShare, kPsnr);
  for (const Curve& curve : curves) {
    std::vector<CurveRow> own;
    for (const CurveRow& row : rows)
      if (row.tree == curve.tree && row.view == first) own.push_back(row);
    of_first.series.push_back(series_of(curve.tree, own, kShare, kPsnr));
  }
  const auto mean = [&](const char* title, const Axis& x, const Axis& y) {
    return plot_of_means(std::string(title) + ": mean of the views", curves, x, y);
  };
  return {{kCurvePlotFiles[0], of_first},
          {kCurvePlotFiles[1], mean("Quality over cut size", kShare, kPsnr)},
          {kCurvePlotFiles[2], mean("Quality over splats", kSplats, kPsnr)},
          {kCurvePlotFiles[3], mean("Quality over time", kTime, kPsnr)},
          {kCurvePlotFiles[4], mean("SSIM over cut size", kShare, kSsim)},
          {kCurvePlotFiles[5], mean("FLIP over cut size", kShare, kFlip)}};
}

std::string html(const CurvePage& page) {
  return page_head("Picture quality over cut size: " + page.curves[0].tree) +
         fmt::format(
             "{}<p>{} Figures: <a href=\"curve.csv\">curve.csv</a>, "
             "<a href=\"curve.json\">curve.json</a>.</p>\n"
             "{}<h2 id=\"plots\">Curves</h2>\n{}<h2 id=\"rows\">Every view and share</h2>\n{}",
             warning(page.rows), escaped(page.method), means_table(page.curves),
             plot_figures(page.plots), rows_table(page.rows)) +
         page_end(page.provenance);
}

}  // namespace voyager::tools
