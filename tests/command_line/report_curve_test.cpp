// `voyager report --curve` as a user runs it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/command_line/page_check.h"
#include "tests/command_line/program.h"
#include "tests/support/camera_files.h"
#include "tests/support/needs.h"
#include "tests/support/test_support.h"

namespace voyager::test {
namespace report_curve_test {
namespace {

class ReportCurve : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    failure_ = failure_of(
        {"voyager synth city --gaussians 10000 --sh-degree 1 -o " + file("c.ply"),
         "voyager synth city --gaussians 11000 --sh-degree 1 -o " + file("other.ply"),
         "voyager bake " + file("c.ply") + " --quality lossless -o " + file("c.voy"),
         "voyager bake " + file("c.ply") + " --quality compact -o " + file("compact.voy"),
         "voyager bake " + file("other.ply") + " -o " + file("other.voy")});
    if (!failure_.empty()) return;
    std::filesystem::create_directory(file("copy"));
    std::filesystem::copy_file(file("c.voy"), file("copy/c.voy"));
    write_first_cameras(file("c.cameras.json"), 3, file("three.json"));
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { ASSERT_EQ(failure_, ""); }

  static std::string file(const std::string& name) { return folder_->file(name); }
  static std::string curve(const std::string& scene, const std::string& rest) {
    return "voyager report " + file(scene) + " --cameras " + file("three.json") +
           " --backend cpu --size 64x36 " + rest;
  }

  static inline TempFolder* folder_ = nullptr;
  static inline std::string failure_;
};

// Measured on this city, in dB; both qualities, all views and the flight are within 1.3 of it.
double expected_psnr(double share) {
  const std::map<double, double> measured = {{0.9, 42.6},  {0.8, 40.5}, {0.65, 38.6}, {0.5, 35.1},
                                             {0.35, 32.7}, {0.2, 30.6}, {0.1, 26.2}};
  return measured.at(share);
}

TEST_F(ReportCurve, HasARowForEachTreeViewAndShare) {
  const std::string trees = " --trees " + file("compact.voy") + " " + file("copy/c.voy");
  const Outcome outcome = run(curve("c.voy", "--curve" + trees + " -o " + file("out")));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const auto json = nlohmann::json::parse(file_bytes(file("out/curve.json")));
  std::vector<nlohmann::json> rows = json["rows"];
  std::set<std::string> seen;
  for (const auto& row : rows) {
    const std::string tree = row["tree"], view = row["view"];
    const double share = row["share"], psnr = row["psnr_db"], cut = row["cut"];
    EXPECT_TRUE(seen.insert(tree + "/" + view + "/" + row["share"].dump()).second) << row.dump();
    EXPECT_NEAR(cut, 10000 * row["cut_share"].get<double>(), 0.01) << row.dump();
    EXPECT_EQ(row["popping"].is_null(), view != "flight") << row.dump();
    EXPECT_GT(row["ms_median"].get<double>(), 0);
    EXPECT_NEAR(psnr, expected_psnr(share), 1.5) << row.dump();
    if (view == "flight") continue;
    EXPECT_NEAR(cut, 10000 * share, 100 * share) << row.dump();
  }
  for (const char* tree : {"c", "compact", "c (2)"})
    for (const char* view : {"0", "1", "2", "flight"})
      for (const char* share : {"0.9", "0.8", "0.65", "0.5", "0.35", "0.2", "0.1"})
        EXPECT_EQ(seen.count(std::string(tree) + "/" + view + "/" + share), 1u);
  EXPECT_EQ(seen.size(), 3 * 4 * 7u);
  const std::string csv = file_bytes(file("out/curve.csv"));
  EXPECT_EQ(static_cast<size_t>(std::count(csv.begin(), csv.end(), '\n')), rows.size() + 1);

  // Fewer nodes are a worse picture: by 1.9 dB where shares are nearest one another in quality.
  for (size_t i = 1; i < rows.size(); ++i)
    if (rows[i]["tree"] == rows[i - 1]["tree"] && rows[i]["view"] == rows[i - 1]["view"]) {
      EXPECT_LT(rows[i]["psnr_db"].get<double>(), rows[i - 1]["psnr_db"].get<double>() - 1)
          << rows[i].dump();
    }
  // The third tree is the first.
  const size_t of_a_tree = rows.size() / 3;
  for (size_t i = 0; i < of_a_tree; ++i) {
    nlohmann::json first = rows[i], third = rows[i + 2 * of_a_tree];
    for (nlohmann::json* row : {&first, &third}) {
      row->erase("tree");
      row->erase("ms_median");
    }
    EXPECT_EQ(first, third);
  }
  EXPECT_NE(outcome.output.find("above c (2)"), std::string::npos) << outcome.output;
  EXPECT_EQ(json["provenance"]["trees"].size(), 3u);
  EXPECT_EQ(json["provenance"]["trees"][1]["bytes"].get<uint64_t>(),
            std::filesystem::file_size(file("compact.voy")));
  if (browser().empty())
    VOYAGER_SKIP_WITHOUT(BROWSER, "no chromium-headless-shell or chromium: pages are not opened");
  const PageCheck check = check_page(browser(), file("out/curve.html"));
  EXPECT_EQ(check.findings, "");
  EXPECT_EQ(check.plots, 6u);
}

TEST_F(ReportCurve, RefusalsAreOneLineAndLeaveNothing) {
  const auto refuse = [](const std::string& command, int code,
                         const std::vector<std::string>& names) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, code) << outcome.output;
    for (const std::string& name : names)
      EXPECT_NE(outcome.output.find(name), std::string::npos) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
  };
  const std::string into = " -o " + file("no");
  refuse(curve("c.voy", "--curve --trees " + file("other.voy") + into), 2,
         {"other.voy", "11000 leaves", "10000", "c.voy"});
  refuse(curve("c.ply", "--curve" + into), 1, {"c.ply", "flat"});
  refuse(curve("c.voy", "--curve --trees " + file("c.ply") + into), 1, {"c.ply", "flat"});
  refuse(curve("c.voy", "--curve --trees " + file("absent.voy") + into), 2, {"absent.voy"});
  refuse(curve("c.voy", "--trees " + file("compact.voy") + into), 1, {"--trees", "--curve"});
  refuse(curve("c.voy", "--curve --target 11" + into), 1, {"--target", "--curve"});
  EXPECT_FALSE(std::filesystem::exists(file("no")));
}

}  // namespace
}  // namespace report_curve_test
}  // namespace voyager::test
