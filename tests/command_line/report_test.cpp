// `voyager report` as a user runs it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/command_line/page_check.h"
#include "tests/command_line/program.h"
#include "tests/support/camera_files.h"
#include "tests/support/needs.h"
#include "tests/support/test_support.h"

namespace voyager::test {
namespace report_test {
namespace {

class Report : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    failure_ = failure_of({"voyager synth city --gaussians 10000 --sh-degree 1 -o " + file("c.ply"),
                           "voyager bake " + file("c.ply") + " -o " + file("c.voy")});
    if (!failure_.empty()) return;
    write_first_cameras(file("c.cameras.json"), 3, file("three.json"));
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { ASSERT_EQ(failure_, ""); }

  static std::string file(const std::string& name) { return folder_->file(name); }
  static std::string report(const std::string& scene, const std::string& rest,
                            const std::string& cameras = "three.json") {
    return "voyager report '" + file(scene) + "' --cameras " + file(cameras) +
           " --backend cpu --quick " + rest;
  }

  static inline TempFolder* folder_ = nullptr;
  static inline std::string failure_;
};

TEST_F(Report, LeavesATableAPageAndPlots) {
  const Outcome outcome = run(report("c.voy", "--size 64x36 --target 10000 -o " + file("out")));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("For 1e+04 ms a frame: --"), std::string::npos) << outcome.output;
  const auto json = nlohmann::json::parse(file_bytes(file("out/report.json")));
  const size_t rows = json["rows"].size();
  EXPECT_GE(rows, 7u);
  const std::string csv = file_bytes(file("out/report.csv"));
  EXPECT_EQ(static_cast<size_t>(std::count(csv.begin(), csv.end(), '\n')), rows + 1);
  EXPECT_EQ(csv.find("scene,camera_set,backend,"), 0u);
  for (const auto& row : json["rows"]) {
    EXPECT_GT(row["ms"]["frame"]["median"].get<double>(), 0) << row.dump();
    EXPECT_GE(row["ms"]["frame"]["p99"].get<double>(), row["ms"]["frame"]["median"].get<double>());
  }
  // All leaves are the scene, but for how many samples a pixel has.
  for (const auto& row : json["rows"])
    if (row["lod"] == "off" && row["exp"] == "exact") {
      EXPECT_GT(row["total_error"]["psnr_db"].get<double>(), 40) << row.dump();
      EXPECT_LT(row["shimmer"]["dolly"].get<double>(), 1.1) << row.dump();
      EXPECT_LT(row["shimmer"]["turn"].get<double>(), 1.1) << row.dump();
    }
  EXPECT_EQ(json["provenance"]["scene"]["bytes"].get<uint64_t>(),
            std::filesystem::file_size(file("c.voy")));
  EXPECT_EQ(json["provenance"]["arguments"].back(), "--target 10000");
  EXPECT_FALSE(std::filesystem::exists(file("out/.report")));
  // The page, as a user sees it: here, for each test of this suite would make a report of its own.
  if (browser().empty())
    VOYAGER_SKIP_WITHOUT(BROWSER, "no chromium-headless-shell or chromium: pages are not opened");
  const PageCheck check = check_page(browser(), file("out/report.html"));
  EXPECT_EQ(check.findings, "");
  EXPECT_EQ(check.images, 2 * json["front"].size());
  EXPECT_GE(check.plots, 4u);
  EXPECT_GT(check.links, check.plots + json["front"].size());
}

// What was measured before the end is not measured again: its times are the same to the last digit.
TEST_F(Report, GoesOnWhereItWasEnded) {
  Outcome outcome{137, ""};
  const std::string command = report("c.voy", "--size 64x36 -o " + file("ended"));
  std::filesystem::create_directories(file("ended/.report"));  // what the last moment leaves
  int ended = 0;
  std::string first, finished;
  // 137: killed. 124: its time was over while it ended by itself.
  const auto was_ended = [&] { return outcome.exit_code == 137 || outcome.exit_code == 124; };
  for (int tenths = 1; was_ended() && tenths < 600; tenths += 1 + tenths / 3) {
    // The target is no part of what is measured: another one throws nothing away.
    outcome = run_shell("timeout --foreground -s KILL " + std::to_string(0.1 * tenths) + " " +
                        program(command + " --target " + std::to_string(tenths)));
    ended += was_ended();
    // A run may be ended when its report is there already: the next one measures it all again.
    if (finished.empty() && std::filesystem::exists(file("ended/report.json")))
      finished = file_bytes(file("ended/report.json"));
    if (!first.empty() || !finished.empty() || !std::filesystem::exists(file("ended/.report")))
      continue;
    for (const auto& entry : std::filesystem::directory_iterator(file("ended/.report")))
      if (entry.path().filename().string().rfind("row-", 0) == 0 &&
          entry.path().extension() == ".json")
        first = file_bytes(entry.path());
  }
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_GT(ended, 0);
  // Nor is anything left of those that were ended.
  for (const auto& entry : std::filesystem::directory_iterator(file("ended")))
    EXPECT_NE(entry.path().filename().string()[0], '.') << entry.path();
  if (first.empty()) return;
  const auto kept = nlohmann::json::parse(first);
  const auto json = nlohmann::json::parse(finished);
  EXPECT_TRUE(std::any_of(json["rows"].begin(), json["rows"].end(), [&](const auto& row) {
    return row == kept;
  })) << first;
}

TEST_F(Report, AFlatSceneIsBakedForIt) {
  const Outcome outcome = run(report("c.ply", "--size 64x36 -o " + file("flat")));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const std::string csv = file_bytes(file("flat/report.csv"));
  for (const char* quality : {",flat,", ",lossless,", ",compact,"})
    EXPECT_NE(csv.find(quality), std::string::npos) << quality;
}

// Photographs of one capture often have several sizes, and names are of any bytes.
TEST_F(Report, CamerasMayDifferInSizeAndNamesNeedNotBeUtf8) {
  auto cameras = nlohmann::json::parse(file_bytes(file("three.json")));
  for (size_t i = 0; i < 3; ++i) {
    cameras[i]["width"] = 32 * (i + 2);
    cameras[i]["height"] = 18 * (i + 2);
  }
  write_bytes(file("sizes.json"), cameras.dump());
  std::filesystem::copy_file(file("c.voy"), file("caf\xe9.voy"));
  const Outcome outcome = run(report("caf\xe9.voy", "-o " + file("sizes"), "sizes.json"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const auto json = nlohmann::json::parse(file_bytes(file("sizes/report.json")));
  EXPECT_EQ(json["provenance"]["scene"]["name"], "caf\xef\xbf\xbd.voy");
  const std::string method = json["method"];
  EXPECT_NE(method.find("3 sizes from 64 x 36 to 128 x 72"), std::string::npos) << method;
  for (const auto& row : json["rows"]) {
    EXPECT_TRUE(row["error"]["popping"].is_null()) << row.dump();
    EXPECT_TRUE(row["total_error"]["popping"].is_null()) << row.dump();
  }
}

TEST_F(Report, RefusalsAreOneLineAndLeaveNothing) {
  const auto refuse = [](const std::string& command, int code, const std::string& names) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, code) << outcome.output;
    EXPECT_NE(outcome.output.find(names), std::string::npos) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
  };
  write_bytes(file("none.json"), "[]");
  refuse(report("none.json", "-o " + file("no")), 2, "none.json");
  refuse(report("c.voy", "-o " + file("no"), "none.json"), 2, "none.json");
  refuse(report("absent.voy", "-o " + file("no")), 2, "absent.voy");
  refuse(report("c.voy", "--full -o " + file("no")), 1, "--full");
  refuse(report("c.voy", "--sms 4 -o " + file("no")), 1, "--sms");
  for (const char* target : {"0", "nan", "inf"})
    refuse(report("c.voy", std::string("--target ") + target + " -o " + file("no")), 1, "--target");
  EXPECT_FALSE(std::filesystem::exists(file("no")));
}

// What the check above relies on: a page that is broken is not passed.
TEST(ReportPage, WhatIsBrokenOnAPageIsFound) {
  if (browser().empty())
    VOYAGER_SKIP_WITHOUT(BROWSER, "no chromium-headless-shell or chromium: pages are not opened");
  const TempFolder folder;
  const auto findings = [&](const std::string& body) {
    write_bytes(folder.file("page.html"), "<!DOCTYPE html><html><body>" + body + "</body></html>");
    return check_page(browser(), folder.file("page.html")).findings;
  };
  EXPECT_EQ(findings("<a id=\"here\" href=\"#here\">here</a><a href=\"page.html\">page</a>"), "");
  const std::string found = findings(
      "<img alt=\"cut\" src=\"data:image/png;base64,AQI=\"><img alt=\"absent\" src=\"no.png\">"
      "<svg width=\"0\"></svg><svg><use xlink:href=\"#glyph\"/></svg>"
      "<a href=\"#row-9\">row</a><a href=\"no.csv\">table</a><a href=\"plot.png\">plot</a>"
      "<script>console.log('said');</script><script>undefined_function();</script>");
  for (const char* one :
       {"image cut:", "image absent:", "svg 0:", "svg 1:", "link #glyph:", "link #row-9:",
        "link no.csv:", "image plot.png:", "\"said\"", "undefined_function is not defined"})
    EXPECT_NE(found.find(one), std::string::npos) << one << " is not among\n" << found;
  EXPECT_EQ(std::count(found.begin(), found.end(), '\n'), 10) << found;
}

}  // namespace
}  // namespace report_test
}  // namespace voyager::test
