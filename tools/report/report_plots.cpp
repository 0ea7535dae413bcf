#include "tools/report/report_plots.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/frame_rows.h"
#include "tools/lod_options.h"

namespace voyager::tools {
namespace {

// What a case has on an axis.
std::string axis_label(const ReportCase& is, const std::string& axis) {
  if (axis == "tau") return draws_cut(is.desc.lod) ? fmt::format("τ {:g}", is.tau) : "all leaves";
  if (axis == "exp")
    return is.desc.exponential == Exponential::lut ? fmt::format("lut {}", is.desc.lut_size)
                                                   : exponential_name(is.desc.exponential);
  if (axis == "sh") return fmt::format("SH {}", is.sh_degree);
  if (axis == "quality") return storage_name(is.storage);
  if (axis == "filter") return is.desc.alpha_filter ? "filter" : "no filter";
  if (axis == "time budget")
    return is.time_budget > 0 ? fmt::format("{:.3g} ms", is.time_budget)
                              : fmt::format("τ {:g}", is.tau);
  return is.desc.search == Search::temporal_visit ? "no slack" : search_name(is.desc.search);
}

Plot front_plot(const std::vector<ReportRow>& rows, const std::vector<size_t>& front) {
  Plot plot{
      "FLIP against the truth, and time", "ms a frame, median", "FLIP", {}, true, false, 820, 480};
  PlotSeries others{"measured", {}, false}, best{"front", {}, true};
  for (size_t i = 0; i < rows.size(); ++i) {
    const bool on_front = std::find(front.begin(), front.end(), i) != front.end();
    if (!on_front) others.points.push_back({rows[i].frame.median, rows[i].truth.flip, "", false});
  }
  for (const size_t i : front)
    best.points.push_back({rows[i].frame.median, rows[i].truth.flip, rows[i].is.name(), true});
  plot.series = {best, others};
  return plot;
}

// Against the same cut: what the axis itself costs. Of the axes that change the cut, against all.
Plot axis_plot(const std::vector<ReportRow>& rows, const std::string& group, bool all) {
  Plot plot{group,
            "ms a frame, median",
            all ? "PSNR against the truth, dB" : "PSNR against the same cut, dB",
            {},
            false,
            false,
            400,
            300};
  PlotSeries series{"", {}, false};
  for (const ReportRow& row : rows)
    if (row.is.group == group || row.is.group == "default")
      series.points.push_back({row.frame.median, all ? row.truth.psnr : row.same.psnr,
                               axis_label(row.is, group), row.is.group == "default"});
  plot.series = {series};
  return plot;
}

// A way to choose detail, over τ; `flat`, every leaf, is a point.
PlotSeries select_series(const std::vector<ReportRow>& rows, Lod lod) {
  std::map<double, PlotPoint> by_tau;
  for (const ReportRow& row : rows) {
    const std::string& group = row.is.group;
    const bool chosen = group == "default" || group == "tau" || group == "select";
    if (!chosen || row.is.desc.lod != lod || (draws_cut(lod) && row.tau == 0)) continue;
    by_tau[row.tau] = {row.frame.median, row.truth.psnr,
                       draws_cut(lod) ? fmt::format("τ {:g}", row.tau) : "", group == "default"};
  }
  PlotSeries series{select_name(lod), {}, true};
  for (const auto& [tau, point] : by_tau) series.points.push_back(point);
  return series;
}

Plot select_plot(const std::vector<ReportRow>& rows) {
  Plot plot{"select", "ms a frame, median", "PSNR against the truth, dB", {}, false, false, 400,
            300};
  for (const Lod lod : {Lod::cut, Lod::blocks, Lod::levels, Lod::all_leaves})
    plot.series.push_back(select_series(rows, lod));
  return plot;
}

constexpr const char* kFrontFile = "front.png";
constexpr const char* kPlottedGroups[] = {"tau", "select",  "exp",    "filter",
                                          "sh",  "quality", "search", "time budget"};

std::string file_of(const std::string& group) {
  std::string file = group + ".png";
  std::replace(file.begin(), file.end(), ' ', '_');
  return file;
}

}  // namespace

std::vector<std::string> report_plot_files() {
  std::vector<std::string> files = {kFrontFile};
  for (const char* group : kPlottedGroups) files.push_back(file_of(group));
  return files;
}

std::vector<PagePlot> report_plots(const std::vector<ReportRow>& rows,
                                   const std::vector<size_t>& front) {
  std::vector<PagePlot> plots = {{kFrontFile, front_plot(rows, front)}};
  for (const char* group : kPlottedGroups) {
    const bool there = std::any_of(rows.begin(), rows.end(),
                                   [&](const ReportRow& row) { return row.is.group == group; });
    if (!there) continue;
    const std::string name(group);
    plots.push_back(
        {file_of(name), name == "select"
                            ? select_plot(rows)
                            : axis_plot(rows, name, name == "tau" || name == "time budget")});
  }
  return plots;
}

}  // namespace voyager::tools
