// `voyager bench` on whole frames: what it runs, what it reports, what it refuses.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::test {
namespace bench_test {
namespace {

using Json = nlohmann::json;

// A small city, and the first cameras of its walk as stills.
class CommandLineBench : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    const std::string city = file("city.ply");
    set_up_failure_ = failure_of({"voyager synth city --gaussians 10000 --sh-degree 1 -o " + city,
                                  "voyager bake " + city + " -o " + file("city.voy")});
    if (!set_up_failure_.empty()) return;
    const Json walk = Json::parse(file_bytes(file("city.cameras.json")));
    Json stills = Json::array();
    for (const size_t i : {0u, 30u, 60u}) stills.push_back(walk[i]);
    write_bytes(file("stills.json"), stills.dump());
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { ASSERT_EQ(set_up_failure_, ""); }

  static std::string file(const std::string& name) { return folder_->file(name); }
  static std::string bench(const std::string& scene, const std::string& rest) {
    return "voyager bench " + file(scene) + " --cameras " + file("stills.json") +
           " --size 96x54 --backend cpu " + rest + " --json " + file("bench.json");
  }
  static Json report_of(const std::string& scene, const std::string& rest) {
    const Outcome result = run(bench(scene, rest));
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return result.exit_code == 0 ? Json::parse(file_bytes(file("bench.json"))) : Json();
  }
  // The refusal names what it should, on one line, and leaves no report.
  static void expect_refusal(const std::string& rest, const std::string& names) {
    std::filesystem::remove(file("bench.json"));
    const Outcome result = run(bench("city.voy", rest));
    EXPECT_EQ(result.exit_code, 1) << rest << "\n" << result.output;
    EXPECT_NE(result.output.find(names), std::string::npos) << rest << "\n" << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
    EXPECT_FALSE(std::filesystem::exists(file("bench.json"))) << rest;
  }

  static TempFolder* folder_;
  static inline std::string set_up_failure_;
};
TempFolder* CommandLineBench::folder_ = nullptr;

void expect_consistent(const Json& row) {
  double stages = 0;
  for (const auto& [stage, ms] : row["ms"].items()) {
    EXPECT_LE(ms["median"], ms["p95"]) << stage;
    EXPECT_LE(ms["p95"], ms["p99"]) << stage;
    if (stage != "frame" && stage != "splat" && stage != "resolve")
      stages += ms["mean"].get<double>();
  }
  EXPECT_GT(row["ms"]["rasterize"]["median"].get<double>(), 0);
  EXPECT_NEAR(row["ms"]["frame"]["mean"].get<double>(), stages, 1e-9 * stages);
  const Json& counters = row["counters"];
  EXPECT_GT(counters["splats"].get<double>(), 0);
  EXPECT_LE(counters["splats"], counters["cut"]);
  EXPECT_LE(counters["pairs_after"], counters["pairs_before"]);
  EXPECT_EQ(counters["pairs_dropped"], 0);
}

// The first camera walks in place of the three, up to what it sees and along it.
TEST_F(CommandLineBench, ACloseUpIsAWalkOfItsOwn) {
  const Json report = report_of("city.voy", "--close-up --stages all --lod on --repeat 1");
  ASSERT_TRUE(report.contains("frames"));
  EXPECT_EQ(report["close_up"], true);
  EXPECT_EQ(report["frames"], 60);
  expect_consistent(report["rows"][0]);
}

TEST_F(CommandLineBench, AChoiceRunsThatOneConfiguration) {
  const Json report = report_of("city.voy", "--stages all --exp ex2 --tau 6 --repeat 5");
  EXPECT_EQ(report["stages"], "all");
  EXPECT_EQ(report["size"], "96x54");
  EXPECT_EQ(report["tau"], 6);
  EXPECT_EQ(report["frames"], 3);
  EXPECT_EQ(report["repeats"], 5);
  ASSERT_EQ(report["rows"].size(), 1u);
  const Json& row = report["rows"][0];
  EXPECT_EQ(row["search"], "temporal");
  EXPECT_EQ(row["slack"], true);
  EXPECT_EQ(row["splat"], "ours");
  EXPECT_EQ(row["exp"], "ex2");
  expect_consistent(row);
  ASSERT_EQ(row["cameras"].size(), 3u);
  EXPECT_GT(row["cameras"][2]["ms"]["frame"].get<double>(), 0);
}

TEST_F(CommandLineBench, StillsAreRepeatedUntilThereAreAHundredFrames) {
  const Json report = report_of("city.voy", "--stages splat --exp exact");
  EXPECT_EQ(report["repeats"], 34);
}

// The frames are those that render draws.
TEST_F(CommandLineBench, CountersAreThoseOfRender) {
  const Json row =
      report_of("city.voy", "--stages all --search streaming --repeat 1 --tau 9")["rows"][0];
  ASSERT_EQ(run("voyager render " + file("city.voy") + " --cameras " + file("stills.json") +
                " --all --size 96x54 --backend cpu --tau 9 --search streaming -o " + file("walk") +
                " --stats " + file("stats.json"))
                .exit_code,
            0);
  const Json frames = Json::parse(file_bytes(file("stats.json")))["frames"];
  for (const char* counter : {"nodes_tested", "cut", "splats", "pairs_before", "pairs_after"}) {
    double sum = 0;
    for (const Json& frame : frames) sum += frame[counter].get<double>();
    EXPECT_DOUBLE_EQ(row["counters"][counter].get<double>(), sum / 3) << counter;
  }
  EXPECT_FALSE(row.contains("cameras"));  // nothing to take a median of
}

TEST_F(CommandLineBench, AblationLeavesOutWhatTheBackendLacksAndSaysWhy) {
  const Json report = report_of("city.voy", "--stages all --repeat 1");
  std::vector<std::string> rows, left_out;
  for (const Json& row : report["rows"]) {
    rows.push_back(row["name"]);
    expect_consistent(row);
    EXPECT_TRUE(row["speedup"]["base"].is_null());
    EXPECT_EQ(row["counters"]["splats"], report["rows"][0]["counters"]["splats"]);
  }
  for (const Json& row : report["left_out"]) {
    left_out.push_back(row["name"]);
    EXPECT_NE(row["why"].get<std::string>().find("3dgs"), std::string::npos) << row;
  }
  EXPECT_EQ(rows, (std::vector<std::string>{"+ alpha-filter", "+ lut", "ours"}));
  EXPECT_EQ(left_out, (std::vector<std::string>{"3dgs", "base", "+ streaming", "+ temporal"}));
}

TEST_F(CommandLineBench, SplatComparesExponentialsWithTheExactOnesImages) {
  const Json report = report_of("city.voy", "--stages splat --repeat 1");
  ASSERT_EQ(report["rows"].size(), 7u);
  const Json& exact = report["rows"][0]["error"];
  EXPECT_EQ(report["rows"][0]["exp"], "exact");
  EXPECT_EQ(exact["largest"], 0);
  EXPECT_TRUE(exact["psnr"].is_null());
  EXPECT_EQ(exact["images"], 3);
  double before = 0;
  for (size_t i = 2; i < 7; ++i) {
    const Json& row = report["rows"][i];
    EXPECT_EQ(row["exp"], "lut");
    EXPECT_EQ(row["lut_size"], 2u << i);
    const double psnr = row["error"]["psnr"];
    EXPECT_GT(psnr, before) << "a larger table is nearer";
    before = psnr;
  }
  EXPECT_GT(report["rows"][1]["error"]["psnr"].get<double>(), before) << "ex2";
}

TEST_F(CommandLineBench, AFlatSceneIsDrawnWithoutASearch) {
  const Json report = report_of("city.ply", "--stages all --repeat 1");
  ASSERT_EQ(report["rows"].size(), 3u);
  for (const Json& row : report["rows"]) {
    EXPECT_TRUE(row["search"].is_null());
    EXPECT_EQ(row["counters"]["cut"], 10000);
    EXPECT_EQ(row["counters"]["nodes_tested"], 0);
  }
  const Json leaves = report_of("city.voy", "--stages all --lod off --repeat 1");
  EXPECT_EQ(leaves["rows"][0]["counters"]["cut"], 10000);
  const Json levels = report_of("city.voy", "--stages all --select levels --repeat 1");
  ASSERT_EQ(levels["rows"].size(), 1u);
  EXPECT_EQ(levels["rows"][0]["select"], "levels");
  EXPECT_EQ(leaves["rows"][0]["select"], "flat");
}

// A budget that no frame can hold, and one that every frame does.
TEST_F(CommandLineBench, ATimeBudgetSteersTauAndTellsEachFrames) {
  const Json late = report_of("city.voy", "--stages all --time-budget 1e-6 --repeat 10");
  const Json& budget = late["rows"][0]["time_budget"];
  EXPECT_EQ(late["rows"].size(), 1u);
  EXPECT_EQ(budget["milliseconds"], 1e-6);
  EXPECT_EQ(budget["on_time"], 0);
  EXPECT_GT(budget["unreachable"], 0);
  for (const char* values : {"tau", "ms", "cut"}) EXPECT_EQ(budget["path"][values].size(), 30u);
  EXPECT_EQ(budget["path"]["tau"].front(), 3);
  EXPECT_EQ(budget["path"]["tau"].back(), 60);
  EXPECT_LT(budget["path"]["cut"].back(), budget["path"]["cut"][2]);
  ASSERT_EQ(budget["psnr"].size(), 3u);
  EXPECT_EQ(budget["psnr"][2]["fixed_tau"], 3);
  EXPECT_EQ(budget["psnr"][0]["budget"], budget["psnr"][0]["fixed"]) << "both are at 3 still";

  const Json held =
      report_of("city.voy", "--stages all --time-budget 1e6 --repeat 10")["rows"][0]["time_budget"];
  EXPECT_EQ(held["on_time"], 1);
  EXPECT_EQ(held["path"]["tau"].back(), 1);
}

TEST_F(CommandLineBench, BothEyesAgainstOne) {
  const Json cameras = Json::parse(file_bytes(file("stills.json")));
  write_bytes(file("two.json"), Json{cameras[0], cameras[1]}.dump());
  const Outcome result =
      run("voyager bench " + file("city.voy") + " --cameras " + file("two.json") +
          " --size 96x54 --backend cpu --stereo --repeat 3 "
          "--json " +
          file("two_bench.json"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const Json report = Json::parse(file_bytes(file("two_bench.json")));
  ASSERT_EQ(report["rows"].size(), 3u);
  const Json &left = report["rows"][0], &right = report["rows"][1], &both = report["rows"][2];
  EXPECT_NEAR(both["counters"]["splats"].get<double>(),
              left["counters"]["splats"].get<double>() + right["counters"]["splats"].get<double>(),
              0.02 * both["counters"]["splats"].get<double>());
  for (const char* part : {"frame", "search", "project", "rasterize"}) {
    const Json& cost = report["stereo"][part];
    EXPECT_EQ(cost["both"], both["ms"][part]["median"]) << part;
    EXPECT_NEAR(
        cost["saved"].get<double>(),
        cost["left"].get<double>() + cost["right"].get<double>() - cost["both"].get<double>(), 1e-9)
        << part;
  }
}

TEST_F(CommandLineBench, ATimeBudgetIsForBothEyes) {
  const Json cameras = Json::parse(file_bytes(file("stills.json")));
  write_bytes(file("pair.json"), Json{cameras[0], cameras[1]}.dump());
  const Outcome result = run(
      "voyager bench " + file("city.voy") + " --cameras " + file("pair.json") +
      " --size 96x54 --backend cpu --stages all --stereo --time-budget 1e-6 --repeat 12 --json " +
      file("pair_bench.json"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const Json budget = Json::parse(file_bytes(file("pair_bench.json")))["rows"][0]["time_budget"];
  EXPECT_EQ(budget["path"]["tau"].size(), 12u);
  EXPECT_EQ(budget["psnr"].size(), 1u);
  EXPECT_GT(budget["path"]["tau"].back(), 3);
}

TEST_F(CommandLineBench, Refusals) {
  expect_refusal("--stages all --time-budget 5 --tau 3", "--time-budget");
  expect_refusal("--stages all --time-budget 0", "found 0, expected a number of milliseconds");
  expect_refusal("--stages all --time-budget 5 --lod off", "--lod off");
  expect_refusal("--stages splat --time-budget 5", "--time-budget");
  expect_refusal("--stages search --time-budget 5", "--time-budget");
  expect_refusal("--stages all --splat 3dgs", "3dgs");
  expect_refusal("--stages splat --sms 16", "--sms");
  expect_refusal("--stages splat --search all", "--search");
  expect_refusal("--stages search --lut-size 16", "--lut-size");
  expect_refusal("--stages all --verify", "--verify");
  for (const std::string choice : {"--lod off", "--select blocks", "--filter off", "--splat ours",
                                   "--exp exact", "--repeat 2"})
    expect_refusal("--stages search " + choice, choice.substr(0, choice.find(' ')));
  expect_refusal("--stages half", "search|splat|all");
}

}  // namespace
}  // namespace bench_test
}  // namespace voyager::test
