// What is in a report's plots.
#include "tools/report/report_plots.h"

#include <gtest/gtest.h>

#include <random>

#include "tools/report/label_room.h"

namespace voyager::tools {
namespace plots_test {
namespace {

std::vector<ReportRow> standard_rows() {
  ReportSubject subject;
  subject.sh_degree = 3;
  subject.storages = {Storage::lossless, Storage::compact};
  subject.exponentials = {Exponential::exact, Exponential::ex2, Exponential::lut};
  std::vector<ReportRow> rows;
  for (const ReportCase& is : report_cases(ReportExtent::standard, subject)) {
    ReportRow row;
    row.is = is;
    row.tau = is.tau;
    row.frame.median = static_cast<double>(rows.size() + 1);
    row.truth.psnr = row.same.psnr = 40;
    rows.push_back(row);
  }
  return rows;
}

Plot plot_of(const std::string& file) {
  const std::vector<ReportRow> rows = standard_rows();
  for (const PagePlot& plot : report_plots(rows, {0}))
    if (plot.file == file) return plot.plot;
  ADD_FAILURE() << file;
  return {};
}

// The default is a value of each axis, not a name beside them.
TEST(ReportPlots, EachPointIsLabelledByItsValueOnTheAxis) {
  for (const auto& [file, value] : {std::pair{"tau.png", "τ 3"},
                                    {"exp.png", "exact"},
                                    {"sh.png", "SH 3"},
                                    {"quality.png", "lossless"},
                                    {"filter.png", "filter"},
                                    {"search.png", "temporal"}}) {
    size_t marked = 0;
    const Plot plot = plot_of(file);
    for (const PlotPoint& point : plot.series[0].points)
      if (point.marked) {
        ++marked;
        EXPECT_EQ(point.label, value) << file;
      } else {
        EXPECT_NE(point.label, value) << file;
      }
    EXPECT_EQ(marked, 1u) << file;
  }
}

TEST(ReportPlots, EachWayToChooseDetailIsAmongTheOthers) {
  const Plot plot = plot_of("select.png");
  std::vector<std::string> names;
  for (const PlotSeries& series : plot.series) {
    names.push_back(series.name);
    EXPECT_FALSE(series.points.empty()) << series.name;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"cut", "blocks", "levels", "flat"}));
}

TEST(LabelRoom, WhatIsTakenDoesNotOverlapAndWhatIsRefusedWould) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, 300), extent(5, 60);
  std::vector<LabelBox> taken;
  const auto overlap = [](const LabelBox& a, const LabelBox& b) {
    return std::max(a.left, b.left) < std::min(a.right, b.right) &&
           std::max(a.top, b.top) < std::min(a.bottom, b.bottom);
  };
  LabelRoom room;
  for (int i = 0; i < 200; ++i) {
    const double x = place(random), y = place(random);
    const LabelBox box{x, y, x + extent(random), y + 9};
    const bool free = std::none_of(taken.begin(), taken.end(),
                                   [&](const LabelBox& other) { return overlap(box, other); });
    EXPECT_EQ(room.take(box), free) << i;
    if (free) taken.push_back(box);
  }
  EXPECT_GT(taken.size(), 10u);
  EXPECT_LT(taken.size(), 200u);
}

}  // namespace
}  // namespace plots_test
}  // namespace voyager::tools
