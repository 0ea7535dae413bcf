// Parts of a report: its configurations, its front, its table, its page.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/support/test_support.h"
#include "tests/unit/tools/report/whole_page.h"
#include "tools/report/kept_rows.h"
#include "tools/report/page.h"
#include "tools/report/pareto.h"
#include "tools/report/plot_axis.h"
#include "tools/report/report_csv.h"
#include "tools/report/report_plots.h"

namespace voyager::tools {
namespace report_test {
namespace {

ReportSubject city() {
  ReportSubject subject;
  subject.sh_degree = 3;
  subject.storages = {Storage::lossless, Storage::compact};
  subject.exponentials = {Exponential::exact, Exponential::ex2, Exponential::lut};
  return subject;
}

ReportRow row(double tau, double ms, double flip) {
  ReportRow found;
  found.is = report_cases(ReportExtent::quick, city())[0];
  found.is.tau = found.tau = tau;
  found.frame = {ms, 1.1 * ms, 1.2 * ms};
  found.stages.assign(kStageCount, {ms / 6, ms / 6, ms / 6});
  found.truth.flip = flip;
  found.truth.psnr = 40;
  found.same.psnr = INFINITY;
  found.same.ssim = 1;
  found.cut = 1000;
  found.timed = 40;
  return found;
}

TEST(Report, NoConfigurationIsMeasuredTwice) {
  ReportSubject cuda = city(), flat = city();
  cuda.baseline = true;
  cuda.search = Search::sweep;
  cuda.exponentials.push_back(Exponential::half2);
  flat.flat = true;
  flat.storages = {Storage::flat, Storage::lossless, Storage::compact};
  for (const ReportSubject& subject : {city(), cuda, flat})
    for (const ReportExtent extent :
         {ReportExtent::quick, ReportExtent::standard, ReportExtent::full}) {
      std::set<std::string> names;
      for (const ReportCase& is : report_cases(extent, subject)) {
        EXPECT_TRUE(names.insert(is.name()).second) << is.name();
        EXPECT_LE(is.sh_degree, subject.sh_degree);
        if (subject.flat) {
          EXPECT_EQ(is.desc.lod, Lod::all_leaves) << is.name();
        }
      }
      EXPECT_GE(names.size(), 5u);
    }
}

TEST(Report, TheStandardOneHasEachAxis) {
  std::set<std::string> groups;
  std::set<uint32_t> luts;
  for (const ReportCase& is : report_cases(ReportExtent::standard, city())) {
    groups.insert(is.group);
    if (is.desc.exponential == Exponential::lut) luts.insert(is.desc.lut_size);
  }
  for (const char* group : {"default", "tau", "select", "exp", "filter", "sh", "quality", "search"})
    EXPECT_TRUE(groups.contains(group)) << group;
  EXPECT_EQ(luts, (std::set<uint32_t>{8, 16, 31, 32, 64, 128}));
}

// Whatever is on the front, nothing is faster and better; whatever is not, something is as fast and
// as good.
TEST(Report, TheFrontIsWhatNothingBeats) {
  std::vector<ReportRow> rows;
  for (int i = 0; i < 60; ++i) rows.push_back(row(i, 1 + i * 37 % 23, 0.01 * (1 + i * 53 % 19)));
  const std::vector<size_t> front = pareto_front(rows);
  const auto beats = [&](size_t a, size_t b) {
    return rows[a].frame.median <= rows[b].frame.median && rows[a].truth.flip <= rows[b].truth.flip;
  };
  for (size_t i = 0; i < rows.size(); ++i) {
    const bool on = std::find(front.begin(), front.end(), i) != front.end();
    bool beaten = false;
    for (size_t k = 0; k < rows.size(); ++k) beaten |= k != i && beats(k, i) && !beats(i, k);
    EXPECT_EQ(on && beaten, false) << i;
    if (!on) {
      EXPECT_TRUE(std::any_of(front.begin(), front.end(), [&](size_t k) { return beats(k, i); }));
    }
  }
}

TEST(Report, OptionsAreThoseOfRender) {
  ReportCase is = report_cases(ReportExtent::quick, city())[0];
  EXPECT_EQ(render_options(is, 3), "--tau 3 --exp exact");
  is.desc.exponential = Exponential::lut;
  is.desc.alpha_filter = false;
  EXPECT_EQ(render_options(is, 0.5), "--tau 0.5 --exp lut --lut-size 32 --filter off");
  is.time_budget = 11.1;
  EXPECT_EQ(render_options(is, 7), "--time-budget 11.1 --exp lut --lut-size 32 --filter off");
  is = report_cases(ReportExtent::quick, city())[0];
  is.desc.lod = Lod::all_leaves;
  EXPECT_EQ(render_options(is, 3), "--lod off --exp exact");
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Report, EachLineOfTheTableHasTheHeadersFields) {
  ReportRow city_row = row(3, 9, 0.02);
  city_row.cut = 4303386.25;
  const std::vector<std::string> lines =
      lines_of(report_csv({"a, \"city\"", "walk", "CPU"}, {city_row, row(15, 4, 0.1)}));
  ASSERT_EQ(lines.size(), 3u);
  const auto fields = [](const std::string& line) {
    bool quoted = false;
    size_t count = 1;
    for (const char c : line) {
      quoted ^= c == '"';
      count += c == ',' && !quoted;
    }
    return count;
  };
  EXPECT_NE(lines[1].find(",4303386.25,"), std::string::npos) << lines[1];
  EXPECT_EQ(fields(lines[1]), fields(lines[0]));
  EXPECT_EQ(fields(lines[2]), fields(lines[0]));
  EXPECT_EQ(lines[1].find("\"a, \"\"city\"\"\",walk,CPU,default,on,3,temporal,cut,on,ours,"), 0u)
      << lines[1];
  EXPECT_NE(lines[1].find(",inf,40,1,"), std::string::npos) << lines[1];
  for (const char* column :
       {"scene,",          ",camera_set,", ",backend,", ",lod,",     ",tau,",
        ",search,",        ",select,",     ",filter,",  ",splat,",   ",exp,",
        ",lut_size,",      ",sh_degree,",  ",quality,", ",cut,",     ",psnr_ref_db,",
        ",psnr_truth_db,", ",ssim,",       ",flip,",    ",max_abs,", ",p999_abs,",
        ",popping,",       ",ms_median,",  ",ms_p95,",  ",ms_p99,",  ",bytes,"})
    EXPECT_NE(lines[0].find(column), std::string::npos) << column;
}

// A pixel that is not finite is counted whichever reference it is compared with, and nobody can
// miss it.
TEST(Report, PixelsThatAreNotFiniteAreTold) {
  ReportRow same = row(3, 9, 0.02), all = row(15, 4, 0.1);
  same.same.not_finite = 7;
  all.truth.not_finite = 8;
  const std::vector<ReportRow> rows = {row(1, 30, 0.01), same, all};
  const std::vector<std::string> lines = lines_of(report_csv({"a", "b", "CPU"}, rows));
  for (const auto& [line, end] : {std::pair{0, ",not_finite"}, {1, ",0"}, {2, ",7"}, {3, ",8"}})
    EXPECT_TRUE(lines[line].ends_with(end)) << lines[line];
  EXPECT_EQ(to_json(same)["error"]["not_finite"], 7);
  EXPECT_EQ(to_json(all)["total_error"]["not_finite"], 8);
  const auto page = [](const std::vector<ReportRow>& shown) {
    return html({"title", {}, "method", "advice", {}, shown, {0}, {}});
  };
  const std::string text = page(rows);
  const size_t told = text.find("<p class=\"wrong\">");
  ASSERT_NE(told, std::string::npos);
  EXPECT_LT(told, text.find("<table>"));
  for (const char* part : {"href=\"#row-1\"", "7 pixels not finite", "href=\"#row-2\"", "8 pixels"})
    EXPECT_NE(text.find(part, told), std::string::npos) << part;
  EXPECT_EQ(text.find("0 pixels"), std::string::npos);
  EXPECT_EQ(page({rows[0]}).find("not finite"), std::string::npos);
}

// What a build before this one kept lacks what it did not measure: it is measured again.
TEST(Report, ARowThatLacksAFigureIsMeasuredAgain) {
  const test::TempFolder folder;
  KeptRows rows(folder.file("kept"), {{"scene", "a"}});
  const ReportRow measured = row(3, 9, 0.02);
  rows.keep({measured, "", ""});
  ASSERT_TRUE(rows.find(measured.is));
  auto json = to_json(measured);
  json["error"].erase("not_finite");
  for (const auto& entry : std::filesystem::directory_iterator(rows.folder()))
    if (entry.path().filename().string().starts_with("row-") && entry.path().extension() == ".json")
      std::ofstream(entry.path()) << json.dump();
  EXPECT_FALSE(rows.find(measured.is));
}

TEST(Report, WhatWasMeasuredIsKeptForTheSameReportAlone) {
  const test::TempFolder folder;
  const std::filesystem::path kept = folder.file("kept");
  const nlohmann::ordered_json one = {{"scene", "a"}}, other = {{"scene", "b"}};
  ReportRow measured = row(3, 9, 0.02);
  measured.joules = 0.5;
  {
    KeptRows rows(kept, one);
    EXPECT_FALSE(rows.find(measured.is));
    rows.keep({measured, "picture", "difference"});
  }
  {
    const KeptRows rows(kept, one);
    const auto found = rows.find(measured.is);
    ASSERT_TRUE(found);
    EXPECT_EQ(to_json(found->row), to_json(measured));
    EXPECT_EQ(found->picture + found->difference, "picturedifference");
    EXPECT_FALSE(rows.find(report_cases(ReportExtent::quick, city())[1]));
  }
  KeptRows rows(kept, other);
  EXPECT_FALSE(rows.find(measured.is));
  rows.remove();
  EXPECT_FALSE(std::filesystem::exists(kept));
}

TEST(Report, ANameThatIsNotUtf8IsShownAsFarAsItCanBe) {
  const test::TempFolder folder;
  const nlohmann::ordered_json provenance = {{"scene", {{"name", "caf\xe9.voy"}}}};
  KeptRows(folder.file("kept"), provenance).keep({row(3, 9, 0.02), "", ""});
  EXPECT_TRUE(KeptRows(folder.file("kept"), provenance).find(row(3, 9, 0.02).is));
  const std::vector<ReportRow> rows = {row(3, 9, 0.02)};
  const std::string text = html({"title", provenance, "method", "advice", {}, rows, {0}, {}});
  EXPECT_NE(text.find("caf\xef\xbf\xbd.voy"), std::string::npos);
}

TEST(Report, AxesHoldTheirValuesAndLabelRoundNumbers) {
  for (const bool logarithmic : {false, true})
    for (const auto& values : {std::vector<double>{3, 4.5, 17},
                               {1e-3, 2e4},
                               {5},
                               {},
                               {100, std::nextafter(100, 200)},
                               {1e-300, 3e-300},
                               {1e15, std::nextafter(1e15, 0)}}) {
      const PlotAxis axis(values, logarithmic);
      for (const double value : values) {
        EXPECT_GE(axis.at(value), 0);
        EXPECT_LE(axis.at(value), 1);
      }
      const auto ticks = axis.ticks();
      EXPECT_LE(ticks.size(), 24u);
      if (values.size() == 2 && !logarithmic) {
        EXPECT_GE(ticks.size(), 3u);
        EXPECT_NE(ticks[0].label, ticks[1].label);
      }
      for (const PlotAxis::Tick& tick : ticks) {
        EXPECT_GE(tick.at, -1e-9);
        EXPECT_LE(tick.at, 1 + 1e-9);
        if (!values.empty()) {
          EXPECT_NEAR(axis.at(std::stod(tick.label)), tick.at, 1e-6);
        }
      }
    }
}

TEST(Report, ThePageIsWholeByItself) {
  const std::vector<ReportRow> rows = {row(3, 9, 0.02), row(15, 4, 0.1)};
  const std::vector<size_t> front = pareto_front(rows);
  ReportPage page{"a <city> & more",
                  {{"scene", "<script>"}},
                  "method",
                  "advice",
                  report_plots(rows, front),
                  rows,
                  front,
                  {{0, {{"image", "\x01\x02"}}}}};
  const std::string text = html(page);
  EXPECT_NE(text.find("<title>a &lt;city&gt; &amp; more</title>"), std::string::npos);
  EXPECT_NE(text.find("<p>method Figures: <a href=\"report.csv\">"), std::string::npos);
  EXPECT_NE(text.find("data:image/png;base64,AQI="), std::string::npos);
  EXPECT_NE(text.find("<svg"), std::string::npos);
  EXPECT_NE(text.find("href=\"#row-"), std::string::npos);
  test::expect_whole_by_itself(text);
}

}  // namespace
}  // namespace report_test
}  // namespace voyager::tools
