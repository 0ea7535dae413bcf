// The command line's contract, as a user meets it.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "runtime/format/reader.h"
#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::test {
namespace command_line_test {
namespace {

namespace fs = std::filesystem;

// A small city, baked once for all tests.
class CommandLine : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    set_up_failure_ =
        failure_of({"voyager synth city --gaussians 10000 --sh-degree 1 -o " + file("city.ply"),
                    "voyager bake " + file("city.ply") + " -o " + file("city.voy") +
                        " --quality lossless --verify"});
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { ASSERT_EQ(set_up_failure_, ""); }

  static std::string file(const std::string& name) { return folder_->file(name); }
  static std::string render(const std::string& scene, const std::string& rest) {
    return "voyager render " + file(scene) + " --cameras " + file("city.cameras.json") +
           " --size 96x54 " + rest;
  }
  // The refusal names what it should, on one line, with the exit code.
  static void expect_refusal(const std::string& command, int exit_code, const std::string& names) {
    const Outcome result = run(command);
    EXPECT_EQ(result.exit_code, exit_code) << command << "\n" << result.output;
    EXPECT_NE(result.output.find(names), std::string::npos) << command << "\n" << result.output;
    EXPECT_LE(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
  }

  static TempFolder* folder_;
  static inline std::string set_up_failure_;
};
TempFolder* CommandLine::folder_ = nullptr;

TEST_F(CommandLine, SynthGivesTheSameBytesForTheSameArguments) {
  ASSERT_EQ(
      run("voyager synth city --gaussians 10000 --sh-degree 1 -o " + file("again.ply")).exit_code,
      0);
  EXPECT_TRUE(file_bytes(file("city.ply")) == file_bytes(file("again.ply")));
  EXPECT_TRUE(file_bytes(file("city.cameras.json")) == file_bytes(file("again.cameras.json")));
  EXPECT_TRUE(file_bytes(file("city.closeup.json")) == file_bytes(file("again.closeup.json")));
  ASSERT_EQ(run("voyager synth city --gaussians 10000 --sh-degree 1 -o - 2>/dev/null >" +
                file("piped.ply"))
                .exit_code,
            0);
  EXPECT_TRUE(file_bytes(file("city.ply")) == file_bytes(file("piped.ply")));
}

TEST_F(CommandLine, BakeReadsStandardInput) {
  ASSERT_EQ(
      run("voyager bake - -o " + file("piped.voy") + " --quality lossless <" + file("city.ply"))
          .exit_code,
      0);
  EXPECT_TRUE(file_bytes(file("city.voy")) == file_bytes(file("piped.voy")));
}

TEST_F(CommandLine, ExportedLeavesEqualTheInputToTheBit) {
  ASSERT_EQ(run("voyager export " + file("city.voy") + " -o " + file("leaves.ply")).exit_code, 0);
  EXPECT_TRUE(file_bytes(file("city.ply")) == file_bytes(file("leaves.ply")));
}

TEST_F(CommandLine, AllLeavesEqualTheFlatSceneToTheBitOnEachBackend) {
  for (const std::string backend : {"cpu", "reference"}) {
    const std::string rest = "--lod off --backend " + backend + " -o ";
    ASSERT_EQ(run(render("city.voy", rest + file("leaves.pfm"))).exit_code, 0);
    ASSERT_EQ(run(render("city.ply", rest + file("flat.pfm"))).exit_code, 0);
    EXPECT_TRUE(file_bytes(file("leaves.pfm")) == file_bytes(file("flat.pfm"))) << backend;
  }
}

// Baselines of detail: flat is every leaf, the others are not the cut.
TEST_F(CommandLine, SelectChoosesWhatIsDrawn) {
  const auto cut_size = [&](const std::string& select) {
    EXPECT_EQ(run(render("city.voy", "--backend cpu --tau 15 --select " + select + " -o " +
                                         file(select + ".pfm") + " --stats " + file("select.json")))
                  .exit_code,
              0);
    return nlohmann::json::parse(file_bytes(file("select.json")))["frames"][0]["cut"].get<int>();
  };
  const int cut = cut_size("cut"), levels = cut_size("levels"), blocks = cut_size("blocks");
  EXPECT_LT(cut, levels);
  EXPECT_NE(blocks, cut);
  EXPECT_EQ(cut_size("flat"), 10000);
  ASSERT_EQ(run(render("city.voy", "--backend cpu --lod off -o " + file("leaves.pfm"))).exit_code,
            0);
  EXPECT_TRUE(file_bytes(file("leaves.pfm")) == file_bytes(file("flat.pfm")));
}

TEST_F(CommandLine, SelectIsRefusedWhereLodSaysOtherwise) {
  const std::string out = " -o " + file("refused.png");
  expect_refusal(render("city.voy", "--lod off --select levels" + out), 1, "--select");
  expect_refusal(render("city.voy", "--lod on --select flat" + out), 1, "--select");
  expect_refusal(render("city.voy", "--select octree" + out), 1, "cut|flat|blocks|levels");
  expect_refusal(render("city.voy", "--budget 40 --select blocks" + out), 1, "blocks");
}

// Drawn flat all the same, its figures would pass for those of the way that was asked for.
TEST_F(CommandLine, AWayToChooseDetailIsRefusedWhereThereIsNoTree) {
  const std::string out = " -o " + file("refused.png"), city = "city.ply";
  for (const std::string choice :
       {"--select cut", "--select blocks", "--select levels", "--lod on"})
    for (const std::string& command :
         {render(city, "--backend cpu " + choice + out),
          "voyager bench " + file(city) + " --cameras " + file("city.cameras.json") +
              " --stages all --backend cpu " + choice + " --json " + file("refused.json")})
      expect_refusal(command, 1, "city.ply, which has no tree");
  const std::string drawn = " --backend cpu -o " + file("flat.png");
  for (const std::string choice : {"--select flat", "--lod off", "--tau 15"})
    EXPECT_EQ(run(render(city, choice + drawn)).exit_code, 0) << choice;
}

TEST_F(CommandLine, FilterOffGivesTheSameImage) {
  for (const std::string exponential : {"exact", "ex2", "lut"}) {
    ASSERT_EQ(run(render("city.voy", "--exp " + exponential + " -o " + file("on.pfm"))).exit_code,
              0);
    ASSERT_EQ(
        run(render("city.voy", "--exp " + exponential + " --filter off -o " + file("off.pfm")))
            .exit_code,
        0);
    EXPECT_TRUE(file_bytes(file("on.pfm")) == file_bytes(file("off.pfm"))) << exponential;
  }
}

// Each frame under a budget is the one that `--tau` gives at the τ that stats.json tells.
TEST_F(CommandLine, ATimeBudgetRaisesTauAndStatsTellIt) {
  const std::string walk = "--all --backend cpu -o " + file("steered") + " --stats " +
                           file("steered.json") + " --time-budget ";
  ASSERT_EQ(run(render("city.voy", walk + "0.001")).exit_code, 0);
  const auto frames = nlohmann::json::parse(file_bytes(file("steered.json")))["frames"];
  EXPECT_EQ(frames[0]["tau"], 3);
  EXPECT_EQ(frames[0]["time_budget"], 0.001);
  EXPECT_EQ(frames[0]["budget"], "late");
  EXPECT_EQ(frames[119]["tau"], 60);
  EXPECT_EQ(frames[119]["budget"], "unreachable");
  for (const int i : {0, 6, 119}) {
    const std::string frame = std::to_string(i), index = std::string(4 - frame.size(), '0') + frame;
    ASSERT_EQ(run(render("city.voy", "--backend cpu --camera " + frame + " --tau " +
                                         frames[i]["tau"].dump() + " -o " + file("fixed.png")))
                  .exit_code,
              0);
    EXPECT_TRUE(file_bytes(file("fixed.png")) == file_bytes(file("steered/" + index + ".png")))
        << i;
  }
}

TEST_F(CommandLine, ATimeBudgetIsRefusedWhereThereIsNothingToSteer) {
  const std::string out = " -o " + file("refused.png");
  expect_refusal(render("city.voy", "--time-budget 5 --tau 3" + out), 1, "--time-budget");
  expect_refusal(render("city.voy", "--time-budget 5 --lod off" + out), 1, "--lod off");
  expect_refusal(render("city.ply", "--backend cpu --time-budget 5" + out), 1, "draws every leaf");
  for (const std::string bad : {"0", "-1", "nan", "inf", "soon"})
    expect_refusal(render("city.voy", "--time-budget " + bad + out), 1, "found " + bad);
}

// Every leaf: there is no cut that one eye could change for the other.
TEST_F(CommandLine, APairIsItsTwoCamerasWithOneCut) {
  const std::string leaves = " --backend cpu --lod off -o ";
  ASSERT_EQ(run(render("city.voy", "--stereo --camera 3" + leaves + file("pair"))).exit_code, 0);
  for (const int camera : {3, 4}) {
    const std::string alone = file(std::to_string(camera) + "_alone.png");
    ASSERT_EQ(
        run(render("city.voy", "--camera " + std::to_string(camera) + leaves + alone)).exit_code,
        0);
    EXPECT_TRUE(file_bytes(alone) ==
                file_bytes(file("pair/000" + std::to_string(camera) + ".png")));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(file("pair")), {}), 2);
  const std::string walk = "--backend cpu --stereo --all --tau 6 -o " + file("pairs") +
                           " --dump-cut " + file("pair_cuts") + " --depth " + file("pair_depths") +
                           " --stats " + file("pairs.json");
  ASSERT_EQ(run(render("city.voy", walk)).exit_code, 0);
  EXPECT_EQ(std::distance(fs::directory_iterator(file("pairs")), {}), 120);
  EXPECT_EQ(std::distance(fs::directory_iterator(file("pair_depths")), {}), 120);
  EXPECT_EQ(std::distance(fs::directory_iterator(file("pair_cuts")), {}), 60);
  EXPECT_EQ(nlohmann::json::parse(file_bytes(file("pairs.json")))["frames"].size(), 60u);
  ASSERT_EQ(run(render("city.voy", "--backend cpu --stereo --camera 2 --tau 6 -o " +
                                       file("second") + " --dump-cut " + file("second.txt")))
                .exit_code,
            0);
  EXPECT_TRUE(file_bytes(file("second.txt")) == file_bytes(file("pair_cuts/0001.txt")));
  EXPECT_TRUE(file_bytes(file("second/0003.png")) == file_bytes(file("pairs/0003.png")));
}

TEST_F(CommandLine, PairsThatThereAreNotAreRefused) {
  expect_refusal(render("city.voy", "--stereo --camera 119 -o " + file("p")), 1, "--camera");
  expect_refusal(render("city.voy", "--stereo -o " + file("p.png")), 1, "--stereo");
  expect_refusal(render("city.voy", "--stereo -o " + file("p") + " --depth " + file("p.pfm")), 1,
                 "--depth");
  auto cameras = nlohmann::json::parse(file_bytes(file("city.cameras.json")));
  cameras.erase(cameras.begin());
  write_bytes(file("odd.json"), cameras.dump());
  expect_refusal("voyager render " + file("city.voy") + " --cameras " + file("odd.json") +
                     " --stereo --all -o " + file("p"),
                 2, "119 cameras");
  EXPECT_FALSE(fs::exists(file("p")));
}

TEST_F(CommandLine, AWalkWritesAFileAFrame) {
  const Outcome result = run(
      render("city.voy", "--all -o " + file("walk") + " --depth " + file("walk_depth") +
                             " --dump-cut " + file("walk_cut") + " --stats " + file("walk.json")));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_TRUE(fs::exists(file("walk/0000.png")));
  EXPECT_TRUE(fs::exists(file("walk/0119.png")));
  EXPECT_TRUE(fs::exists(file("walk_depth/0119.pfm")));
  EXPECT_TRUE(fs::exists(file("walk_cut/0119.txt")));

  const auto stats = nlohmann::json::parse(file_bytes(file("walk.json")));
  ASSERT_EQ(stats["frames"].size(), 120u);
  for (size_t i = 1; i < 120; ++i) {
    const auto &before = stats["frames"][i - 1], &frame = stats["frames"][i];
    EXPECT_LT(frame["nodes_tested"], frame["nodes_total"]);
    // Nodes that entered and left account for the change of the cut.
    EXPECT_EQ(before["cut"].get<int64_t>() + frame["entered"].get<int64_t>() -
                  frame["left"].get<int64_t>(),
              frame["cut"].get<int64_t>());
    EXPECT_LE(frame["pairs_after"].get<int64_t>(), frame["pairs_before"].get<int64_t>());
    EXPECT_EQ(frame["pairs_dropped"], 0);
  }
  EXPECT_NE(stats["device"], "");
  EXPECT_EQ(stats["frames"][0]["tau_star"].get<std::string>().substr(0, 2), "0x");
}

TEST_F(CommandLine, BenchTimesEverySearchAndFindsTheSameCuts) {
  const Outcome result =
      run("voyager bench " + file("city.voy") + " --cameras " + file("city.cameras.json") +
          " --stages search --backend cpu --tau 6 --verify --json " + file("bench.json"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const auto report = nlohmann::json::parse(file_bytes(file("bench.json")));
  ASSERT_EQ(report["searches"].size(), 4u);
  for (const auto& row : report["searches"]) {
    EXPECT_GT(row["ms"]["median"].get<double>(), 0.0);
    EXPECT_GE(row["ms"]["p99"], row["ms"]["median"]);
    EXPECT_EQ(row["last_cut"], report["searches"][0]["last_cut"]);
  }
  EXPECT_EQ(report["searches"][0]["nodes_tested"], report["nodes"]);
  EXPECT_LT(report["searches"][3]["nodes_tested"], report["searches"][2]["nodes_tested"]);
}

TEST_F(CommandLine, BenchRefusals) {
  const std::string bench =
      "voyager bench " + file("city.voy") + " --cameras " + file("city.cameras.json") + " ";
  const std::string json = "--json " + file("refused.json");
  expect_refusal(bench + "--backend cpu --sms 16 " + json, 1, "--sms");
  expect_refusal(bench + "--json " + file("refused.txt"), 1, ".json");
  expect_refusal("voyager bench " + file("city.ply") + " --cameras " + file("city.cameras.json") +
                     " --backend cpu " + json,
                 2, "without a tree");
  EXPECT_FALSE(fs::exists(file("refused.json")));
}

TEST_F(CommandLine, EverySearchDumpsTheSameCuts) {
  auto cameras = nlohmann::json::parse(file_bytes(file("city.cameras.json")));
  auto walk = nlohmann::json::array();
  for (int i = 0; i < 6; ++i) {
    walk.push_back(cameras[40]);
    walk[i]["position"][0] = walk[i]["position"][0].get<double>() + 0.02 * (i / 2);
  }
  write_bytes(file("small_walk.json"), walk.dump());
  const auto rest = [&](const std::string& name) {
    return "voyager render " + file("city.voy") + " --cameras " + file("small_walk.json") +
           " --size 96x54 --tau 15 --all -o " + file(name) + " --dump-cut " + file(name + "_cut") +
           " --stats " + file(name + ".json");
  };
  const std::pair<std::string, std::string> searches[] = {{"exhaustive", " --search exhaustive"},
                                                          {"streaming", " --search streaming"},
                                                          {"temporal", " --search temporal"},
                                                          {"sweep", " --search sweep"},
                                                          {"auto", ""},
                                                          {"visit", " --slack off"}};
  for (const auto& [name, choice] : searches) {
    const Outcome result = run(rest(name) + choice);
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const auto stats = nlohmann::json::parse(file_bytes(file(name + ".json")));
    for (size_t i = 0; i < 6; ++i) {
      const std::string number = "000" + std::to_string(i);
      EXPECT_TRUE(file_bytes(file("exhaustive_cut/" + number + ".txt")) ==
                  file_bytes(file(name + "_cut/" + number + ".txt")))
          << name << i;
      EXPECT_TRUE(file_bytes(file("exhaustive/" + number + ".png")) ==
                  file_bytes(file(name + "/" + number + ".png")))
          << name << i;
      const auto& frame = stats["frames"][i];
      const bool whole = name == "exhaustive" || name == "streaming";
      const bool swept = frame["search"] == "sweep" && (name == "sweep" || name == "auto");
      if (!swept) {  // as on a CPU
        EXPECT_EQ(frame["search"], whole ? name : i == 0 ? "streaming" : "temporal") << name << i;
      }
      if (name == "temporal" && i % 2 == 1) {
        EXPECT_EQ(frame["nodes_tested"], 0) << i;  // nothing has moved
      }
    }
  }
}

TEST_F(CommandLine, BackendsDumpTheSameCut) {
  for (const std::string tau : {"0", "3", "15"}) {
    for (const std::string backend : {"auto", "cpu", "reference"})
      ASSERT_EQ(run(render("city.voy", "--tau " + tau + " --backend " + backend + " --dump-cut " +
                                           file(backend + ".txt") + " -o " + file("a.png")))
                    .exit_code,
                0);
    for (const std::string backend : {"auto", "cpu"})
      EXPECT_TRUE(file_bytes(file(backend + ".txt")) == file_bytes(file("reference.txt")))
          << backend << " at " << tau;
    EXPECT_FALSE(file_bytes(file("cpu.txt")).empty());
  }
}

TEST_F(CommandLine, CompactIsSmallAndCutsAlike) {
  ASSERT_EQ(run("voyager bake " + file("city.ply") + " -o " + file("compact.voy")).exit_code, 0);
  ASSERT_EQ(run(render("city.voy", "--dump-cut " + file("lossless.txt") + " -o " + file("a.png")))
                .exit_code,
            0);
  ASSERT_EQ(run(render("compact.voy", "--dump-cut " + file("compact.txt") + " -o " + file("b.png")))
                .exit_code,
            0);
  EXPECT_TRUE(file_bytes(file("lossless.txt")) == file_bytes(file("compact.txt")));
}

TEST_F(CommandLine, AnInterpolatedCutIsASceneOfItsOwn) {
  ASSERT_EQ(run("voyager export " + file("city.voy") + " -o " + file("cut.ply") + " --cut-camera " +
                file("city.cameras.json") + " --camera 3 --size 96x54 --tau 3")
                .exit_code,
            0);
  const Outcome info = run("voyager info " + file("cut.ply") + " --json");
  ASSERT_EQ(info.exit_code, 0) << info.output;
  ASSERT_EQ(run(render("city.voy", "--camera 3 --stats " + file("s.json") + " -o " + file("a.png")))
                .exit_code,
            0);
  const auto stats = nlohmann::json::parse(file_bytes(file("s.json")));
  EXPECT_EQ(nlohmann::json::parse(info.output)["gaussians"], stats["frames"][0]["cut"]);
}

TEST_F(CommandLine, BadUsageIsNamedAndExitsWithOne) {
  expect_refusal("voyager fly", 1, "fly");
  expect_refusal(render("city.voy", "--search guess -o a.png"), 1, "guess");
  expect_refusal(render("city.voy", "--slack maybe -o a.png"), 1, "maybe");
  expect_refusal(render("city.voy", "--backend cpu --exp half2 -o a.png"), 1, "half2");
  expect_refusal(render("city.voy", "--splat 2dgs -o a.png"), 1, "2dgs");
  for (const std::string backend : {"cpu", "reference"})
    expect_refusal(render("city.voy", "--splat 3dgs --backend " + backend + " -o " + file("x.png")),
                   1, "3dgs");
  expect_refusal(render("city.voy", "--tau -1 -o a.png"), 1, "-1");
  expect_refusal(render("city.voy", "--tau nan -o a.png"), 1, "nan");
  expect_refusal(render("city.voy", "--camera 120 -o a.png"), 1, "119");
  expect_refusal(render("city.voy", "-o a.jpg"), 1, "a.jpg");
  expect_refusal(render("city.ply", "--dump-cut c.txt -o " + file("x.png")), 1, "--dump-cut");
  expect_refusal(render("city.voy", "--backend reference --exp lut -o " + file("x.png")), 1,
                 "exact");
  expect_refusal("voyager render " + file("city.voy") + " --cameras " + file("city.cameras.json") +
                     " --size 0x5 -o a.png",
                 1, "0x5");
  expect_refusal("voyager synth city --gaussians 5 -o " + file("x.ply"), 1, "5");
  EXPECT_FALSE(fs::exists(file("x.png")));
}

TEST_F(CommandLine, RefusedInputIsNamedAndExitsWithTwo) {
  const std::string ply = file_bytes(file("city.ply"));
  write_bytes(file("short.ply"), ply.substr(0, ply.size() / 2));
  expect_refusal(
      "voyager bake " + file("short.ply") + " -o " + file("never.voy") + " 2>" + file("log"), 2,
      "");
  EXPECT_NE(file_bytes(file("log")).find("short.ply"), std::string::npos);
  EXPECT_FALSE(fs::exists(file("never.voy")));
  expect_refusal("voyager info " + file("absent.voy"), 2, "absent.voy");
  expect_refusal("voyager info " + file("city.cameras.json"), 2, "city.cameras.json");

  write_bytes(file("bad.json"), R"([{"width": 10, "height": 10, "fx": 0, "fy": 1}])");
  expect_refusal("voyager render " + file("city.voy") + " --cameras " + file("bad.json") + " -o " +
                     file("x.png"),
                 2, "fx");
  write_bytes(file("bad.json"), "[{\"width\": 10,");
  expect_refusal("voyager render " + file("city.voy") + " --cameras " + file("bad.json") + " -o " +
                     file("x.png"),
                 2, "bad.json");
}

TEST_F(CommandLine, ADamagedChunkThatTheFrameNeedsExitsWithThreeAndWritesNothing) {
  const SceneFile scene(open_file_source(file("city.voy")));
  std::string bytes = file_bytes(file("city.voy"));
  bytes[scene.chunks().back().offset + 100] ^= 1;  // the finest nodes
  write_bytes(file("damaged.voy"), bytes);

  expect_refusal(render("damaged.voy", "--lod off -o " + file("needs.png")), 3, "damaged.voy");
  EXPECT_FALSE(fs::exists(file("needs.png")));

  // A cut that stops above the damage is drawn as if nothing had happened.
  ASSERT_EQ(run(render("damaged.voy", "--camera 80 --tau 200 -o " + file("coarse.pfm"))).exit_code,
            0);
  ASSERT_EQ(run(render("city.voy", "--camera 80 --tau 200 -o " + file("whole.pfm"))).exit_code, 0);
  EXPECT_TRUE(file_bytes(file("coarse.pfm")) == file_bytes(file("whole.pfm")));
}

TEST_F(CommandLine, AWalkThatMeetsDamageLeavesNothing) {
  const SceneFile scene(open_file_source(file("city.voy")));
  std::string bytes = file_bytes(file("city.voy"));
  bytes[scene.chunks().back().offset + 100] ^= 1;
  write_bytes(file("damaged.voy"), bytes);
  const Outcome walk = run(render(
      "damaged.voy", "--all --tau 0 -o " + file("no_walk") + " --depth " + file("no_depth")));
  EXPECT_EQ(walk.exit_code, 3) << walk.output;
  EXPECT_FALSE(fs::exists(file("no_walk")));
  EXPECT_FALSE(fs::exists(file("no_depth")));
}

TEST_F(CommandLine, NoOutputIsAnInputOrAnotherOutput) {
  const std::string ply = file_bytes(file("city.ply")),
                    cameras = file_bytes(file("city.cameras.json"));
  expect_refusal("voyager bake " + file("city.ply") + " -o " + file("city.ply"), 1, ".voy");
  expect_refusal("voyager bake " + file("city.voy") + " -o " + file("city.voy"), 1, "an input");
  expect_refusal("voyager export " + file("city.voy") + " -o " + file("city.voy"), 1, "an input");
  expect_refusal(
      render("city.voy", "-o " + file("a.png") + " --stats " + file("city.cameras.json")), 1,
      "an input");
  expect_refusal(render("city.voy", "-o " + file("z.pfm") + " --depth " + file("./z.pfm")), 1,
                 "another output");
  expect_refusal(render("city.voy", "-o " + file("z.png") + " --depth " + file("z2.png")), 1,
                 ".pfm");
  EXPECT_TRUE(ply == file_bytes(file("city.ply")));
  EXPECT_TRUE(cameras == file_bytes(file("city.cameras.json")));
}

TEST_F(CommandLine, AKilledCommandLeavesNoPartialFile) {
  fs::create_directory(file("killed"));
  run("voyager synth city --gaussians 100000000 -o " + file("killed/big.ply") +
      " & sleep 0.3; kill -TERM $!; wait $!");
  EXPECT_TRUE(fs::is_empty(file("killed")));
  const Outcome full = run("voyager synth city --gaussians 100000 -o " + file("killed/big.ply"));
  EXPECT_EQ(full.exit_code, 0) << full.output;
}

TEST_F(CommandLine, CamerasOutOfRangeAreRefusedWithFileCameraAndField) {
  const std::string rest = R"(, "height": 9, "rotation": [[1,0,0],[0,1,0],[0,0,1]], "fy": 9)";
  const auto camera = [&](const std::string& fields) {
    write_bytes(file("bad.json"), "[{" + fields + rest + "}]");
    return "voyager render " + file("city.voy") + " --cameras " + file("bad.json") + " -o " +
           file("x.png");
  };
  expect_refusal(camera(R"("width": 9, "fx": 9, "position": [1e19, 0, 0])"), 2,
                 "camera 0: position");
  expect_refusal(camera(R"("width": 9, "fx": 1e-300, "position": [0, 0, 0])"), 2, "camera 0: fx");
  expect_refusal(camera(R"("width": 9, "fx": 9, "cx": 1e300, "position": [0, 0, 0])"), 2,
                 "camera 0: fx");
  expect_refusal(camera(R"("width": 9, "fx": 1e999, "position": [0, 0, 0])"), 2, "bad.json");
  const std::string deep = std::string(150000, '[') + std::string(150000, ']');
  expect_refusal(camera("\"width\": " + deep), 2, "bad.json: found JSON of more than 16 levels");
  expect_refusal(camera(R"("width": [[9]])"), 2, "width: found an array");
  EXPECT_FALSE(fs::exists(file("x.png")));
}

TEST_F(CommandLine, AnEmptySceneBakesRendersAndHasAnEmptyCut) {
  const std::string ply = file_bytes(file("city.ply"));
  const size_t header = ply.find("end_header\n") + 11;
  std::string empty = ply.substr(0, header);
  empty.replace(empty.find("vertex 10000"), 12, "vertex 0");
  write_bytes(file("empty.ply"), empty);
  ASSERT_EQ(
      run("voyager bake " + file("empty.ply") + " -o " + file("empty.voy") + " --verify").exit_code,
      0);
  const Outcome drawn =
      run(render("empty.voy", "--background 1,0,0 --dump-cut " + file("empty.txt") + " -o " +
                                  file("empty.pfm")));
  EXPECT_EQ(drawn.exit_code, 0) << drawn.output;
  EXPECT_TRUE(fs::exists(file("empty.txt")));
  EXPECT_TRUE(file_bytes(file("empty.txt")).empty());
}

TEST_F(CommandLine, AnOutputThatCannotBeWrittenExitsWithFour) {
  expect_refusal(render("city.voy", "-o " + file("no/such/folder.png")), 4, "no/such/folder.png");
}

// Whether a device is there is asked of the system, not of the program: one that does not draw is a
// failure, and no skip.
bool has_cuda_device() {
  if (!fs::exists(VOYAGER_BIN_DIR "/../lib/libvoyager_cuda.so")) return false;
  return fs::exists("/dev/nvidia0") || fs::exists("/dev/nvhost-gpu");
}

TEST_F(CommandLine, CudaDrawsBothWays) {
  if (!has_cuda_device())
    VOYAGER_SKIP_WITHOUT(CUDA, "no libvoyager_cuda.so beside libvoyager.so, or no NVIDIA GPU");
  for (const std::string splat : {"ours", "3dgs"}) {
    const std::string picture = file(splat + ".png");
    const Outcome drawn =
        run(render("city.voy", "--backend cuda --splat " + splat + " -o " + picture));
    EXPECT_EQ(drawn.exit_code, 0) << drawn.output;
    EXPECT_TRUE(fs::exists(picture));
  }
}

TEST_F(CommandLine, WithoutADeviceCudaExitsWithFour) {
  if (has_cuda_device()) GTEST_SKIP() << "this machine has a CUDA device";
  const bool module = fs::exists(VOYAGER_BIN_DIR "/../lib/libvoyager_cuda.so");
  for (const std::string splat : {"ours", "3dgs"}) {
    const std::string picture = file(splat + ".png");
    expect_refusal(render("city.voy", "--backend cuda --splat " + splat + " -o " + picture), 4,
                   module ? "CUDA: found no NVIDIA driver" : "libvoyager_cuda.so: not found");
    EXPECT_FALSE(fs::exists(picture));
  }
}

TEST_F(CommandLine, HelpHasAnExampleOfEachCommand) {
  for (const std::string command :
       {"synth", "bake", "export", "info", "render", "bench", "devices"}) {
    const Outcome help = run("voyager " + command + " --help");
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.output.find("Example: voyager " + command), std::string::npos) << help.output;
  }
}

TEST_F(CommandLine, TheSampleRendersAStill) {
  const Outcome result = run("c_minimal " + file("city.voy") + " " + file("still.png"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(file_bytes(file("still.png")).substr(1, 3), "PNG");
  EXPECT_NE(run("c_minimal " + file("absent.voy") + " " + file("none.png")).exit_code, 0);
  EXPECT_FALSE(fs::exists(file("none.png")));
}

}  // namespace
}  // namespace command_line_test
}  // namespace voyager::test
