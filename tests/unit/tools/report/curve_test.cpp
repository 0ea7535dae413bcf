// Parts of a tree's curve: the tau of a share, the views, the means, the table, the page.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "runtime/lod/build.h"
#include "runtime/select/cut.h"
#include "tests/support/test_support.h"
#include "tests/support/tree_clouds.h"
#include "tests/unit/tools/report/whole_page.h"
#include "tools/report/curve_page.h"
#include "tools/report/curve_text.h"
#include "tools/report/cut_counts.h"
#include "tools/report/report_plan.h"

namespace voyager::tools {
namespace curve_test {
namespace {

TEST(ReportCurve, CutsAreCountedAsAnExhaustiveSearchFindsThem) {
  Workers workers;
  for (const size_t size : {1, 2, 3, 1000, 70000}) {
    const TreeRule rule = size > 1000 ? test::kHierarchicalGs : TreeRule();  // which is quick
    const BakedScene baked = build_tree(test::random_cloud(size, 11, 0), workers, {}, rule);
    CutCounts counts(baked.tree, workers);
    ExhaustiveSearch search;
    for (const Vec3f& centre : {Vec3f{0, 0, 0}, {1, 2, -3}, {100, -40, 7}}) {
      counts.look_from(centre);
      for (const float target : {1e-6f, 1e-3f, 0.02f, 0.1f, 0.5f, 3.0f, INFINITY}) {
        search.run(baked.tree, {}, {centre, target}, workers);
        EXPECT_EQ(counts.at(target), search.cut().size()) << size << " Gaussians, " << target;
      }
    }
  }
}

TEST(ReportCurve, TheTauOfAShareIsFound) {
  const auto cut_at = [](double tau) { return static_cast<uint64_t>(1e6 / (1 + tau / 7)); };
  for (const uint64_t wanted : {900000, 500000, 100000, 1000}) {
    const TauOfCut found = tau_of_cut(wanted, cut_at);
    EXPECT_EQ(found.cut, cut_at(found.tau));
    const auto expected = static_cast<double>(wanted);
    EXPECT_NEAR(static_cast<double>(found.cut), expected, 1e-4 * expected);
  }
}

// Where cuts jump past what is wanted: the nearer side, whichever it is.
TEST(ReportCurve, WhereNoTauHasTheShareTheNearestIsTaken) {
  const auto jump = [](double tau) -> uint64_t { return tau < 5 ? 1000 : 100; };
  EXPECT_EQ(tau_of_cut(800, jump).cut, 1000u);
  EXPECT_EQ(tau_of_cut(300, jump).cut, 100u);
  EXPECT_LT(tau_of_cut(800, jump).tau, 5);
  EXPECT_GE(tau_of_cut(300, jump).tau, 5);
  // Tau has an end: at 0 much has merged, and what surrounds the camera never does.
  const TauOfCut most = tau_of_cut(2000, jump), least = tau_of_cut(10, jump);
  EXPECT_EQ(most.tau, 0);
  EXPECT_EQ(most.cut, 1000u);
  EXPECT_EQ(least.cut, 100u);
  EXPECT_TRUE(std::isfinite(least.tau));
}

TEST(ReportCurve, FourViewsOrAllThereAreAreCompared) {
  const test::TempFolder folder;
  const std::string file = folder.file("cameras.json");
  for (const size_t count : {1, 2, 3, 4, 5, 6, 40, 700}) {
    nlohmann::json cameras = nlohmann::json::array();
    for (size_t i = 0; i < count; ++i)
      cameras.push_back({{"id", i},
                         {"img_name", "a"},
                         {"width", 64},
                         {"height", 36},
                         {"position", {i, 0, 0}},
                         {"rotation", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                         {"fx", 50},
                         {"fy", 50}});
    std::ofstream(file) << cameras.dump();
    for (const ReportExtent extent :
         {ReportExtent::quick, ReportExtent::standard, ReportExtent::full}) {
      const ReportPlan plan = curve_plan(file, {}, extent);
      EXPECT_GE(plan.compared.size(), std::min<size_t>(4, count)) << count;
      EXPECT_EQ(std::set<size_t>(plan.compared.begin(), plan.compared.end()).size(),
                plan.compared.size());
      EXPECT_EQ(plan.compared.front(), 0u);
      EXPECT_LT(plan.compared.back(), plan.path.size());
    }
  }
}

CurveRow row(const std::string& tree, const std::string& view, double share, double psnr) {
  CurveRow found;
  found.tree = tree;
  found.view = view;
  found.share = found.cut_share = share;
  found.tau = 1 / share;
  found.cut = 1000 * share;
  found.milliseconds = 10 * share;
  found.error.psnr = psnr;
  found.error.ssim = 0.9;
  return found;
}

std::vector<CurveRow> rows_of(const std::string& tree, double psnr) {
  std::vector<CurveRow> rows;
  for (const char* view : {"0", "1"})
    for (const double share : kCurveShares)
      rows.push_back(row(tree, view, share, psnr + (view[0] == '1' ? 2 : 0)));
  for (const double share : kCurveShares) rows.push_back(row(tree, kFlight, share, 10));
  return rows;
}

TEST(ReportCurve, MeansAreOfTheViewsAlone) {
  const std::vector<Curve> curves = mean_curves(rows_of("a", 30));
  ASSERT_EQ(curves.size(), 1u);
  ASSERT_EQ(curves[0].means.size(), std::size(kCurveShares));
  for (const CurveRow& mean : curves[0].means) {
    EXPECT_EQ(mean.error.psnr, 31);
    EXPECT_NEAR(mean.cut, 1000 * mean.share, 1e-9);
  }
}

TEST(ReportCurve, AMeanHasWhatItsRowsHave) {
  CurveRow one = row("a", "0", 0.5, 30), other = row("a", "1", 0.5, 40);
  EXPECT_FALSE(mean_row({one, other}, "mean").error.popping);
  other.error.popping = 3;
  other.error.ssim.reset();
  other.error.not_finite = 4;
  one.error.not_finite = 1;
  const CurveRow mean = mean_row({one, other}, "mean");
  EXPECT_EQ(mean.view, "mean");
  EXPECT_EQ(mean.error.popping, 3);
  EXPECT_FALSE(mean.error.ssim);
  EXPECT_EQ(mean.error.not_finite, 5u);
}

TEST(ReportCurve, TheTableComparesWithTheLastTreeAndMarksSharesThatCutsLack) {
  std::vector<CurveRow> rows = rows_of("first", 36);
  const std::vector<CurveRow> last = rows_of("last", 30.5);
  EXPECT_EQ(curve_table(mean_curves(rows)).find('*'), std::string::npos);
  rows[0].cut_share = 0.8;
  rows.insert(rows.end(), last.begin(), last.end());
  const std::vector<CurveLine> lines = curve_lines(mean_curves(rows));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].cells[0], "37.00*");
  EXPECT_EQ(lines[0].cells[1], "37.00");
  EXPECT_EQ(lines[1].cells[1], "+5.50");
  EXPECT_EQ(lines[2].name, "last");
  EXPECT_EQ(lines[2].cells[1], "31.50");
  EXPECT_NE(curve_table(mean_curves(rows)).find(kStarText), std::string::npos);
}

// One view without its share is enough, however well the others make up for it.
TEST(ReportCurve, AStarIsForAnyView) {
  std::vector<CurveRow> rows = rows_of("a", 36);
  rows[0].cut_share = 0.95;
  rows[std::size(kCurveShares)].cut_share = 0.85;  // their mean is right
  EXPECT_EQ(curve_lines(mean_curves(rows))[0].cells[0], "37.00*");
}

TEST(ReportCurve, EachLineHasTheHeadersFields) {
  std::vector<CurveRow> rows = {row("a, \"b\"", "0", 0.9, INFINITY)};
  rows[0].error.ssim.reset();
  const std::string csv = curve_csv(rows);
  const size_t end = csv.find('\n');
  EXPECT_EQ(csv.substr(0, end),
            "tree,view,share,cut_share,tau,cut,splats,pairs,psnr_db,ssim,flip,popping,ms_median,"
            "not_finite");
  EXPECT_EQ(csv.substr(end + 1), "\"a, \"\"b\"\"\",0,0.9,0.9,1.111111111,900,0,0,inf,,0,,9,0\n");
}

// Images smaller than SSIM's window have none.
TEST(ReportCurve, WhatARowLacksIsNoPoint) {
  std::vector<CurveRow> rows = rows_of("a", 30);
  for (CurveRow& row : rows) row.error.ssim.reset();
  const std::vector<PagePlot> plots = curve_plots(rows, mean_curves(rows));
  for (const PagePlot& plot : plots)
    EXPECT_EQ(plot.plot.series[0].points.empty(), plot.file == "curve_ssim.png") << plot.file;
}

TEST(ReportCurve, ThePageIsWholeByItself) {
  std::vector<CurveRow> rows = rows_of("<a>", 30);
  const std::vector<Curve> curves = mean_curves(rows);
  const std::vector<PagePlot> plots = curve_plots(rows, curves);
  ASSERT_EQ(plots.size(), 6u);
  EXPECT_EQ(plots[0].plot.series[0].points[0].y, 30);
  EXPECT_EQ(plots[1].plot.series[0].points[0].y, 31);
  EXPECT_EQ(plots[3].plot.series[0].points[0].x, 9);
  const CurvePage page{{{"scene", "<script>"}}, "method & more", plots, rows, curves};
  const std::string text = html(page);
  EXPECT_EQ(text.find("<a>"), std::string::npos);
  EXPECT_NE(text.find("method &amp; more"), std::string::npos);
  test::expect_whole_by_itself(text);
  EXPECT_EQ(text.find("not finite"), std::string::npos);
  rows[3].error.not_finite = 2;
  EXPECT_NE(html(page).find("1 rows have pixels that are not finite"), std::string::npos);
}

}  // namespace
}  // namespace curve_test
}  // namespace voyager::tools
