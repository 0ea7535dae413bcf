// No command removes or empties what it did not make, whatever it is told to write where.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::keep_data_test {
namespace {

using namespace voyager::test;
namespace fs = std::filesystem;

class KeepData : public ::testing::Test {
 protected:
  // small is baked in a second; large takes more than 16 MB of memory, and so a work folder.
  static void SetUpTestSuite() {
    made_ = new TempFolder;
    failure_ = failure_of({"voyager synth city --gaussians 10000 --sh-degree 0 -o " + small(),
                           "voyager synth city --gaussians 80000 --sh-degree 0 -o " + large()});
  }
  static void TearDownTestSuite() { delete made_; }
  void SetUp() override { ASSERT_EQ(failure_, ""); }

  static std::string small() { return made_->file("small.ply"); }
  static std::string large() { return made_->file("large.ply"); }
  std::string file(const std::string& name) const { return folder.file(name); }

  // Every file below the folder with its bytes.
  std::map<std::string, std::string> everything() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder.file("")))
      found[entry.path().string()] = entry.is_regular_file() ? file_bytes(entry.path()) : "";
    return found;
  }
  // With the exit code and all of `says` on one line, and nothing else in the world.
  void expect_refused(const std::string& command, int code, const std::vector<std::string>& says) {
    const auto before = everything();
    const Outcome refused = run(command);
    EXPECT_EQ(refused.exit_code, code) << command << "\n" << refused.output;
    for (const std::string& part : says)
      EXPECT_NE(refused.output.find(part), std::string::npos) << part << "\n" << refused.output;
    EXPECT_EQ(std::count(refused.output.begin(), refused.output.end(), '\n'), 1) << refused.output;
    EXPECT_TRUE(everything() == before) << command;
  }

  // Until what a bake has read of its input is written.
  void wait_until_still() const {
    for (auto before = everything();;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      auto now = everything();
      if (now == before) return;
      before = std::move(now);
    }
  }

  TempFolder folder;

 private:
  static inline TempFolder* made_ = nullptr;
  static inline std::string failure_;
};

bool wait_for(const std::string& path) {
  for (int i = 0; i < 18000 && !fs::exists(path); ++i)  // a sanitizer is slow
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return fs::exists(path);
}

// A bake in the background, which waits in the middle of its standard input, behind what is read
// before the folder is made, until it is told to go on. Its folder is for this.
class WaitingBake {
 public:
  WaitingBake(const std::string& command, const std::string& ply, const std::string& folder)
      : go_(folder + "/go"), said_(folder + "/said"), ended_(folder + "/ended") {
    fs::create_directory(folder);
    const std::string input = "head -c 300000 " + ply + "; while [ ! -e " + go_ +
                              " ]; do sleep 0.02; done; tail -c +300001 " + ply;
    run_shell("( ( " + input + " ) | " + program(command) + " >" + said_ + " 2>&1; touch " +
              ended_ + " ) </dev/null >/dev/null 2>&1 &");
  }
  ~WaitingBake() { end(); }
  WaitingBake(const WaitingBake&) = delete;
  WaitingBake& operator=(const WaitingBake&) = delete;

  void end() const {
    write_bytes(go_, "");
    EXPECT_TRUE(wait_for(ended_));
  }
  std::string said() const { return file_bytes(said_); }

 private:
  std::string go_, said_, ended_;
};

TEST_F(KeepData, AFolderThatIsNotABakesIsRefusedAndStays) {
  fs::create_directory(file("s.voy.work"));
  write_bytes(file("s.voy.work/thesis.txt"), "x");
  const std::string bake = "voyager bake " + large() + " -o " + file("s.voy");
  expect_refused(bake + " --memory 16", 2, {"s.voy.work: found thesis.txt", "one of a bake"});
  expect_refused(bake + " --work " + file("s.voy.work"), 2, {"s.voy.work: found thesis.txt"});
  // Names of a bake's files alone do not make it a bake's.
  fs::rename(file("s.voy.work/thesis.txt"), file("s.voy.work/words"));
  expect_refused(bake + " --memory 16", 2, {"s.voy.work: found words"});
}

TEST_F(KeepData, WhatIsPutIntoAWorkFolderStaysAndIsNamed) {
  const std::string bake =
      "voyager bake " + small() + " -o " + file("s.voy") + " --work " + file("w");
  ASSERT_EQ(run(bake + " --step split").exit_code, 0);
  // The last two look like a bake's, but this one has no cells.
  const std::string names[] = {"thesis.txt", "cell-99999.rows", "cell-00.rows"};
  for (const std::string& name : names) write_bytes(file("w/" + name), "x");
  const Outcome baked = run(bake);
  ASSERT_EQ(baked.exit_code, 0) << baked.output;
  for (const std::string& name : names) {
    EXPECT_NE(baked.output.find(name), std::string::npos) << baked.output;
    EXPECT_EQ(file_bytes(file("w/" + name)), "x");
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(file("w")), {}), 3);
}

TEST_F(KeepData, AWorkFolderThatWasThereStaysEmptied) {
  fs::create_directory(file("w"));
  const std::string bake = "voyager bake " + small() + " -o " + file("s.voy") + " --work ";
  ASSERT_EQ(run(bake + file("w") + " --step split").exit_code, 0);
  ASSERT_EQ(run(bake + file("w")).exit_code, 0);
  EXPECT_TRUE(fs::is_empty(file("w")));
  for (const std::string name : {"new/w", "new/./b/../w/"}) {
    ASSERT_EQ(run(bake + file(name)).exit_code, 0);
    EXPECT_FALSE(fs::exists(file("new"))) << name;
  }
}

TEST_F(KeepData, ARefusedBakeLeavesNoWorkFolder) {
  write_bytes(file("junk.ply"), "ply\nno header\n");
  for (const std::string& input : {file("junk.ply"), "- <" + file("junk.ply")})
    for (const std::string step : {"all", "split", "cells", "merge"})
      expect_refused("voyager bake -o " + file("s.voy") + " --work " + file("new/w") + " --step " +
                         step + " " + input,
                     step == "all" || step == "split" ? 2 : 1, {});
  fs::create_directory(file("w"));
  expect_refused(
      "voyager bake -o " + file("s.voy") + " --work " + file("w") + " " + file("junk.ply"), 2, {});
}

TEST_F(KeepData, ASecondBakeToTheSameOutputDoesNotTouchTheFirst) {
  const std::string bake =
      "voyager bake - -o " + file("s.voy") + " --quality lossless --work " + file("w");
  const WaitingBake first(bake, small(), file("made"));
  ASSERT_TRUE(wait_for(file("w/words"))) << first.said();
  wait_until_still();
  expect_refused(bake + " < " + small(), 4, {file("w") + ": found another process at work"});
  expect_refused("voyager bake " + small() + " -o " + file("s.voy") + " --work " + file("w"), 2,
                 {file("w")});
  first.end();
  ASSERT_EQ(
      run("voyager bake " + small() + " -o " + file("whole.voy") + " --quality lossless").exit_code,
      0);
  EXPECT_TRUE(file_bytes(file("s.voy")) == file_bytes(file("whole.voy")));
}

TEST_F(KeepData, AWorkFolderThatIsGoneEndsTheBake) {
  const WaitingBake bake("voyager bake - -o " + file("s.voy") + " --work " + file("w"), small(),
                         file("made"));
  ASSERT_TRUE(wait_for(file("w/words"))) << bake.said();
  wait_until_still();
  fs::rename(file("w"), file("elsewhere"));
  bake.end();
  EXPECT_NE(bake.said().find(file("w/spool") + ": create: No such file"), std::string::npos)
      << bake.said();
  EXPECT_FALSE(fs::exists(file("s.voy")) || fs::exists(file("w")));
  EXPECT_TRUE(fs::exists(file("elsewhere/words")));
}

// Its exit code; 128 and the signal's number where it was ended after so many milliseconds.
int run_ended(const std::string& command, double milliseconds, int signal) {
  const pid_t child = ::fork();
  if (child == 0) {
    const std::string quiet = "exec " + program(command) + " >/dev/null 2>&1";
    ::execl("/bin/sh", "sh", "-c", quiet.c_str(), nullptr);
    ::_exit(127);
  }
  std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(milliseconds));
  ::kill(child, signal);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// Of a .ply with so many rows.
std::string first_rows(const std::string& ply, size_t rows, size_t wanted) {
  std::string header = ply.substr(0, ply.find("end_header\n") + 11);
  const std::string body = ply.substr(header.size(), (ply.size() - header.size()) / rows * wanted);
  header.replace(header.find("vertex "),
                 header.find('\n', header.find("vertex ")) - header.find("vertex "),
                 "vertex " + std::to_string(wanted));
  return header + body;
}

// In cells only where VOYAGER_LARGE_TREES is set: property.BakeStopped has cells of few Gaussians.
TEST_F(KeepData, ABakeThatIsEndedAtAnyMomentGoesOnToTheSameBytes) {
  const char* const given = std::getenv("VOYAGER_SEED");
  const unsigned seed =
      given != nullptr ? static_cast<unsigned>(std::stoul(given)) : std::random_device{}();
  std::printf("seed %u (VOYAGER_SEED)\n", seed);
  std::mt19937 random(seed);
  const std::string ply = file("c.ply"), scene = file("s.voy"), work = file("w");
  if (std::getenv("VOYAGER_LARGE_TREES") != nullptr)
    ASSERT_EQ(run("voyager synth city --sh-degree 0 --gaussians 262144 -o " + ply).exit_code, 0);
  else
    write_bytes(ply, first_rows(file_bytes(small()), 10000, 2000));
  ASSERT_EQ(run("voyager bake " + ply + " -o " + scene).exit_code, 0);
  const std::string whole = file_bytes(scene);
  const auto before = everything();
  const std::string steps[] = {" --step split", " --step cells", " --step encode", ""};
  double milliseconds[std::size(steps)];
  for (const int signal : {0, SIGKILL, SIGTERM, SIGINT}) {  // first to see how long each takes
    fs::remove(scene);
    for (size_t i = 0; i < std::size(steps); ++i) {
      const std::string bake =
          "voyager bake " + ply + " -o " + scene + " --memory 160 --work " + work + steps[i];
      for (int end = 0; signal != 0 && end < 2; ++end) {
        const double after = std::uniform_real_distribution<>(0, milliseconds[i])(random);
        const int code = run_ended(bake, after, signal);
        ASSERT_TRUE(code == 0 || code == 128 + signal) << bake << ": " << code;
        ASSERT_TRUE(!fs::exists(scene) || file_bytes(scene) == whole) << bake;
      }
      const auto start = std::chrono::steady_clock::now();
      const Outcome ended = run(bake);
      ASSERT_EQ(ended.exit_code, 0) << bake << "\n" << ended.output;
      const std::chrono::duration<double, std::milli> took =
          std::chrono::steady_clock::now() - start;
      if (signal == 0) milliseconds[i] = took.count();
    }
    // What was ended before it was marked is an empty folder of somebody's.
    if (fs::exists(work) && fs::is_empty(work)) fs::remove(work);
    EXPECT_TRUE(everything() == before) << signal;
  }
}

// What a killed one leaves is a hidden folder, which the next removes.
TEST_F(KeepData, ATilesetThatIsKilledAtAnyMomentLeavesNothingToTheNext) {
  const std::string scene = file("s.voy");
  ASSERT_EQ(run("voyager bake " + small() + " -o " + scene).exit_code, 0);
  fs::create_directory(file("t"));
  write_bytes(file("t/notes.txt"), "x");
  const std::string command = "voyager export " + scene + " --spz -o " + file("t/tileset.json");
  for (const double milliseconds : {15.0, 30.0, 60.0, 90.0})
    run_ended(command, milliseconds, SIGKILL);
  ASSERT_EQ(run(command).exit_code, 0);
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(file("t")))
    names.insert(entry.path().filename().string());
  EXPECT_EQ(names, (std::set<std::string>{"notes.txt", "tile_00000.glb", "tileset.json"}));
}

// The folder that nobody named is the first one's as well.
TEST_F(KeepData, ASecondBakeFromAFolderOfItsOwnDoesNotTouchTheFirst) {
  const std::string bake = "voyager bake - -o " + file("s.voy") + " --memory 16";
  const WaitingBake first(bake, large(), file("made"));
  ASSERT_TRUE(wait_for(file("s.voy.work/words"))) << first.said();
  wait_until_still();
  expect_refused(bake + " < " + large(), 4, {"s.voy.work: found another process at work"});
  first.end();
  EXPECT_TRUE(fs::exists(file("s.voy"))) << first.said();
  EXPECT_FALSE(fs::exists(file("s.voy.work")));
}

TEST_F(KeepData, OutputAndInputsAreNeverInTheWorkFolder) {
  fs::create_directories(file("t/within"));
  fs::create_directory_symlink(file("t"), file("link"));
  fs::copy(small(), file("t/within/a.ply"));
  fs::copy(small(), file("t/words"));
  fs::create_symlink(file("t/within/a.ply"), file("b.ply"));
  fs::create_symlink(file("t/within/new.voy"), file("new.voy"));
  const std::string bake = "voyager bake ", to = " -o " + file("s.voy");
  const std::string inside = "found it in the work folder";
  for (const std::string output :
       {"t/s.voy", "link/s.voy", "t/within/s.voy", "t/../t/s.voy", "new.voy"})
    expect_refused(bake + small() + " -o " + file(output) + " --work " + file("t"), 1,
                   {file(output), inside});
  expect_refused(bake + small() + " -o " + file("t/s.voy") + " --work " + file("link"), 1,
                 {inside});
  expect_refused(bake + small() + to + " --work " + file("s.voy"), 1, {inside});
  for (const std::string work : {"s.voy/w", "s.voy/v/w", "x/../s.voy/w"})
    expect_refused(bake + small() + to + " --work " + file(work), 1,
                   {file("s.voy") + ": found the work folder"});
  for (const std::string input : {"t/within/a.ply", "t/words", "link/words", "b.ply"})
    expect_refused(bake + file(input) + to + " --work " + file("t"), 1, {file(input), inside});
  // The folder that nobody names.
  fs::create_directory(file("u.voy.work"));
  fs::copy(large(), file("u.voy.work/positions"));
  expect_refused(bake + file("u.voy.work/positions") + " -o " + file("u.voy") + " --memory 16", 1,
                 {inside});
  fs::copy(small(), file("v.voy.refine"));
  expect_refused(bake + file("v.voy.refine") + " -o " + file("v.voy") + " --refine 1", 1,
                 {"v.voy.refine", "an input"});
}

// What --refine keeps is removed at the end: nothing else of that name is, or is written over.
TEST_F(KeepData, AFileNamedLikeWhatRefineKeepsIsRefusedAndStays) {
  write_bytes(file("s.voy.refine"), "my own");
  expect_refused("voyager bake " + small() + " -o " + file("s.voy") + " --refine 1", 2,
                 {"s.voy.refine: found a file that no bake has written"});
}

TEST_F(KeepData, AFileNamedLikeWhatOptimizeKeepsIsRefusedAndStays) {
  write_bytes(file("s.voy.optimize"), "my own");
  expect_refused("voyager bake " + small() + " -o " + file("s.voy") + " --optimize draft", 2,
                 {"s.voy.optimize: found a file that no bake has written"});
  write_bytes(file("s.voy.optimize"), std::string("optimi5\0 learned", 16));
  expect_refused("voyager bake " + small() + " -o " + file("s.voy") + " --optimize draft", 2,
                 {"s.voy.optimize: found what --optimize has learned by another version"});
}

TEST_F(KeepData, AnOutputIsWrittenThroughASymbolicLink) {
  fs::create_directory(file("far"));
  write_bytes(file("far/there.voy"), "before");
  fs::create_symlink("far/there.voy", file("link.voy"));
  fs::create_symlink("far/new.voy", file("dangling.voy"));
  for (const std::string name : {"link", "dangling"})
    ASSERT_EQ(run("voyager bake " + small() + " -o " + file(name + ".voy")).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(file("link.voy")));
  EXPECT_TRUE(fs::is_symlink(file("dangling.voy")));
  EXPECT_TRUE(file_bytes(file("far/there.voy")) == file_bytes(file("far/new.voy")));
  EXPECT_EQ(std::distance(fs::directory_iterator(file("far")), {}), 2);
  // An output that a link takes to an input is that input.
  fs::create_symlink("far/there.voy", file("out.ply"));
  expect_refused("voyager export " + file("link.voy") + " -o " + file("out.ply"), 1, {"an input"});
}

TEST_F(KeepData, AWalkReplacesItsNumbersAndLeavesTheRest) {
  fs::create_directories(file("walk/.partial-notes"));
  write_bytes(file("walk/.partial-notes/thesis.txt"), "x");
  write_bytes(file("walk/9999.png"), "mine");
  write_bytes(file("walk/0000.png"), "an earlier walk's");
  fs::copy(fs::path(small()).replace_extension(".cameras.json"), file("cameras.json"));
  const std::string render = "voyager render " + small() + " --backend cpu --size 16x9 --cameras " +
                             file("cameras.json") + " --all -o " + file("walk");
  ASSERT_EQ(run(render).exit_code, 0);
  EXPECT_EQ(file_bytes(file("walk/.partial-notes/thesis.txt")), "x");
  EXPECT_EQ(file_bytes(file("walk/9999.png")), "mine");
  EXPECT_EQ(file_bytes(file("walk/0000.png")).substr(1, 3), "PNG");
  fs::remove(file("walk/0007.png"));
  fs::create_directory(file("walk/0007.png"));
  expect_refused(render, 4, {"walk/0007.png: found a directory"});
}

TEST_F(KeepData, AWalkDoesNotReplaceItsInputs) {
  const std::string cameras = fs::path(small()).replace_extension(".cameras.json");
  fs::create_directory(file("g"));
  fs::create_directory(file("outside"));
  fs::copy(cameras, file("g/0000.txt"));
  fs::copy(cameras, file("g/0001.png"));
  fs::copy(cameras, file("g/0002.pfm"));
  fs::create_symlink("g/0000.txt", file("cameras.json"));
  fs::create_hard_link(file("g/0001.png"), file("hard.json"));
  ASSERT_EQ(run("voyager bake " + small() + " -o " + file("s.voy")).exit_code, 0);
  const std::string render =
      "voyager render " + file("s.voy") + " --backend cpu --size 16x9 --all --cameras ";
  const std::string input = "as an input", other = "as another output";
  for (const std::string cut : {"g/0000.txt", "cameras.json"})
    expect_refused(render + file(cut) + " -o " + file("outside") + " --dump-cut " + file("g"), 1,
                   {file("g/0000.txt"), input});
  for (const std::string image : {"g/0001.png", "hard.json"})
    expect_refused(render + file(image) + " -o " + file("g"), 1, {file("g/0001.png"), input});
  expect_refused(render + file("g/0002.pfm") + " -o " + file("outside") + " --depth " + file("g"),
                 1, {file("g/0002.pfm"), input});
  expect_refused(render + cameras + " -o " + file("g") + " --stats " + file("g/0003.png"), 1,
                 {file("g/0003.png"), other});
}

TEST_F(KeepData, AReportDoesNotReplaceItsInputs) {
  const std::string cameras = fs::path(small()).replace_extension(".cameras.json");
  const std::string options = " --quick --size 16x9 --backend cpu -o " + file("r") + " --cameras ";
  const std::string report = "voyager report ";
  fs::create_directories(file("r/.report"));
  if (run(report + "--help").exit_code != 0) GTEST_SKIP() << "built without it";
  ASSERT_EQ(run("voyager bake " + small() + " -o " + file("s.voy")).exit_code, 0);
  for (const std::string name : {"report.json", "time_budget.png", "curve_flip.png"})
    fs::copy(cameras, file("r/" + name));
  fs::copy(file("s.voy"), file("r/curve.csv"));
  fs::copy(file("s.voy"), file("r/.report/compact.voy"));
  for (const std::string name : {"report.json", "time_budget.png"})
    expect_refused(report + file("s.voy") + options + file("r/" + name), 1,
                   {file("r/" + name), "as an input"});
  expect_refused(report + file("r/.report/compact.voy") + options + cameras, 1,
                 {".report/compact.voy", "found it in the work folder"});
  expect_refused(report + file("s.voy") + options + file("r/curve_flip.png") + " --curve", 1,
                 {file("r/curve_flip.png"), "as an input"});
  expect_refused(
      report + file("s.voy") + options + cameras + " --curve --trees " + file("r/curve.csv"), 1,
      {file("r/curve.csv"), "as an input"});
}

// A scene that is not there: what is said first is what was found out first.
TEST_F(KeepData, AReportWithoutAPlaceForAPictureIsRefusedBeforeTheWork) {
  const std::string cameras = fs::path(small()).replace_extension(".cameras.json");
  if (run("voyager report --help").exit_code != 0) GTEST_SKIP() << "built without it";
  for (const std::string name : {"report.csv", "front.png", "time_budget.png", "curve_time.png"}) {
    fs::create_directories(file("r/" + name));
    const std::string curve = name.starts_with("curve") ? " --curve" : "";
    expect_refused("voyager report " + file("absent.voy") + " --quick --backend cpu -o " +
                       file("r") + " --cameras " + cameras + curve,
                   4, {file("r/" + name) + ": found a directory"});
    fs::remove(file("r/" + name));
  }
}

TEST_F(KeepData, AHiddenFolderThatIsNotAReportsIsRefusedAndStays) {
  fs::create_directories(file("report/.report"));
  write_bytes(file("report/.report/thesis.txt"), "x");
  const std::string cameras = fs::path(small()).replace_extension(".cameras.json").string();
  const Outcome refused = run("voyager report " + small() + " --cameras " + cameras + " -o " +
                              file("report") + " --quick --size 16x9 --backend cpu");
  if (refused.output.find("not a command") != std::string::npos) GTEST_SKIP() << "built without it";
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_NE(refused.output.find(".report: found thesis.txt"), std::string::npos) << refused.output;
  EXPECT_EQ(file_bytes(file("report/.report/thesis.txt")), "x");
}

}  // namespace
}  // namespace voyager::keep_data_test
