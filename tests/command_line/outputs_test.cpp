// What cannot be written or read is found out before the work, not after it, and nothing waits for
// the other end of a pipe.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <filesystem>

#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::outputs_test {
namespace {

using namespace voyager::test;
namespace fs = std::filesystem;

class Outputs : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    failure_ = failure_of({"voyager synth city --gaussians 10000 --sh-degree 0 -o " + file("c.ply"),
                           "voyager bake " + file("c.ply") + " -o " + file("c.voy")});
    fs::create_directory(file("folder"));
    fs::create_symlink("/dev/full", file("full"));
    ::mkfifo(file("pipe").c_str(), 0666);
    // The same under names that options take.
    for (const std::string kind : {"folder", "full", "pipe"})
      for (const std::string name :
           {".voy", ".ply", ".hier", ".png", ".pfm", ".json", ".txt", ".spz"})
        fs::create_symlink(kind, file(kind + name));
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { ASSERT_EQ(failure_, ""); }
  static std::string file(const std::string& name) { return folder_->file(name); }

  // Within seconds, whatever is at the other end: the exit code, and one line that has `says`.
  static void expect_refused(const std::string& command, int code, const std::string& says) {
    const Outcome refused = run_shell("timeout 20 " + program(command));
    EXPECT_EQ(refused.exit_code, code) << command << "\n" << refused.output;
    EXPECT_NE(refused.output.find(says), std::string::npos) << says << "\n" << refused.output;
    EXPECT_EQ(std::count(refused.output.begin(), refused.output.end(), '\n'), 1) << refused.output;
  }

  static inline TempFolder* folder_ = nullptr;
  static inline std::string failure_;
};

// Scenes that are not there: what is said first is what was found out first.
TEST_F(Outputs, AreFoundToBeUnwritableBeforeTheWork) {
  const std::string absent = file("absent.voy"), cameras = " --cameras " + file("c.cameras.json");
  const std::string render = "voyager render " + absent + cameras + " --backend cpu -o ";
  const std::pair<std::string, std::string> kinds[] = {
      {"folder", "found a directory"}, {"full", "found a terminal"}, {"pipe", "found a FIFO"}};
  for (const auto& [kind, found] : kinds) {
    const auto to = [&](const std::string& extension) { return file(kind + extension); };
    const std::pair<std::string, std::string> commands[] = {
        {"voyager synth city --gaussians 100000000 -o " + to(".ply"), to(".ply")},
        {"voyager synth city --gaussians 100000000 -o " + to(".spz"), to(".spz")},
        {"voyager bake - -o " + to(".voy") + " </dev/zero", to(".voy")},
        {"voyager export " + file("c.voy") + " -o " + to(".ply"), to(".ply")},
        {"voyager export " + file("c.voy") + " -o " + to(".hier"), to(".hier")},
        {render + to(".png"), to(".png")},
        {render + file("o.png") + " --depth " + to(".pfm"), to(".pfm")},
        {render + file("o.png") + " --dump-cut " + to(".txt"), to(".txt")},
        {render + file("o.png") + " --stats " + to(".json"), to(".json")},
        {"voyager bench " + absent + cameras + " --backend cpu --json " + to(".json"),
         to(".json")}};
    for (const auto& [command, path] : commands) expect_refused(command, 4, path + ": " + found);
  }
  for (const std::string kind : {"full", "pipe"})
    expect_refused(render + file(kind) + " --all", 4, file(kind));
  expect_refused(render + file("no/such/o.png"), 4, file("no/such/o.png"));
  EXPECT_FALSE(fs::exists(file("o.png")));
  EXPECT_TRUE(fs::is_fifo(file("pipe")));
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(Outputs, TheCamerasBesideACityAreFoundToBeUnwritableToo) {
  for (const std::string cameras : {"d.cameras.json", "e.closeup.json"}) {
    fs::create_directory(file(cameras));
    const std::string city = file(cameras.substr(0, 1) + ".ply");
    expect_refused("voyager synth city --gaussians 100000000 -o " + city, 4,
                   file(cameras) + ": found a directory");
    EXPECT_FALSE(fs::exists(city));
  }
}

TEST_F(Outputs, RoomIsAskedForBeforeTheWork) {
  struct statvfs info = {};
  const bool there = ::access("/dev/shm", W_OK) == 0 && ::statvfs("/dev/shm", &info) == 0;
  const uint64_t free = uint64_t{info.f_bavail} * info.f_frsize;
  if (!there || free > 100'000'000'000) GTEST_SKIP() << "no /dev/shm, or one of more than 100 GB";
  fs::create_symlink("/dev/shm/voyager-test-room.ply", file("shm.ply"));
  fs::create_symlink("/dev/shm/voyager-test-room.voy", file("shm.voy"));
  if (free < 24'000'000'000)
    expect_refused("voyager synth city --gaussians 100000000 -o " + file("shm.ply"), 4,
                   "MB free on the device, expected 24801 MB");
  // A header tells how much is to come.
  const auto write_claim = [](uint64_t gaussians) {
    const std::string ply = file_bytes(file("c.ply"));
    std::string claim = ply.substr(0, ply.find("end_header\n") + 11);
    claim.replace(claim.find("vertex 10000"), 12, "vertex " + std::to_string(gaussians));
    write_bytes(file("claim.ply"), claim);
  };
  write_claim(4'000'000'000);
  for (const std::string& work : {std::string(), " --work " + file("work")})
    expect_refused("voyager bake - -o " + file("shm.voy") + " --memory 1000000000" + work + " <" +
                       file("claim.ply"),
                   4, "MB free on the device");
  // The copy of the inputs takes 0.7 of the device, the scene 0.5: each has room, both have not.
  write_claim(free / 80);
  expect_refused("voyager bake - -o " + file("shm.voy") +
                     " --work /dev/shm/voyager-test-room.work <" + file("claim.ply"),
                 4, "MB for the scene and a copy of the inputs");
  EXPECT_FALSE(fs::exists("/dev/shm/voyager-test-room.work"));
  EXPECT_FALSE(fs::exists("/dev/shm/voyager-test-room.ply"));
  EXPECT_FALSE(fs::exists("/dev/shm/voyager-test-room.voy"));
}

TEST_F(Outputs, ScenesAndCamerasThatAreNoFilesAreRefusedAtOnce) {
  const std::string scene = file("c.voy"), cameras = " --cameras " + file("c.cameras.json");
  const std::pair<std::string, std::string> kinds[] = {{file("pipe"), "found a FIFO"},
                                                       {file("folder"), "found a directory"},
                                                       {"/dev/zero", "found a terminal"},
                                                       {"/dev/tty", "found a terminal"}};
  for (const auto& [path, found] : kinds) {
    for (const std::string& command :
         {"voyager info " + path, "voyager bake " + path + " -o " + file("o.voy"),
          "voyager export " + path + " -o " + file("o.ply"),
          "voyager render " + path + cameras + " --backend cpu -o " + file("o.png"),
          "voyager render " + scene + " --cameras " + path + " --backend cpu -o " + file("o.png"),
          "voyager export " + scene + " --cut-camera " + path + " -o " + file("o.ply"),
          "voyager bench " + path + cameras + " --backend cpu --json " + file("o.json"),
          "voyager bench " + scene + " --cameras " + path + " --backend cpu --json " +
              file("o.json")})
      expect_refused(command, 2, found);
    const Outcome sample =
        run_shell("timeout 20 " + program("c_minimal " + path + " " + file("o.png")));
    EXPECT_EQ(sample.exit_code, 2) << sample.output;
  }
  EXPECT_FALSE(fs::exists(file("o.voy")));
}

TEST_F(Outputs, AFullStandardOutputFailsForEveryText) {
  for (const std::string& command :
       {std::string("--help"), std::string("--version"), "info " + file("c.voy")})
    expect_refused("voyager " + command + " >/dev/full", 4, "standard output");
}

TEST_F(Outputs, TheSampleReplacesNothingThatIsNoFile) {
  for (const std::string kind : {"pipe", "full", "folder"})
    expect_refused("c_minimal " + file("c.voy") + " " + file(kind), 4, file(kind));
  EXPECT_TRUE(fs::is_fifo(file("pipe")));
}

TEST_F(Outputs, TheSampleDoesNotWriteOverItsScene) {
  fs::copy(file("c.voy"), file("own.voy"));
  fs::create_symlink("own.voy", file("own.png"));
  fs::create_hard_link(file("own.voy"), file("hard.png"));
  for (const std::string name : {"own.voy", "own.png", "hard.png"})
    expect_refused("c_minimal " + file("own.voy") + " " + file(name), 1, "as the scene");
  EXPECT_TRUE(file_bytes(file("own.voy")) == file_bytes(file("c.voy")));
}

// As voyager itself.
TEST_F(Outputs, TheSampleWritesThroughLinks) {
  fs::create_directory(file("far"));
  fs::create_symlink("far/there.png", file("dangling.png"));
  fs::create_symlink("dangling.png", file("link.png"));
  ASSERT_EQ(run("c_minimal " + file("c.voy") + " " + file("link.png")).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(file("link.png")) && fs::is_symlink(file("dangling.png")));
  EXPECT_EQ(file_bytes(file("far/there.png")).substr(1, 3), "PNG");
  EXPECT_EQ(std::distance(fs::directory_iterator(file("far")), {}), 1);
  fs::create_symlink("b.png", file("a.png"));
  fs::create_symlink("a.png", file("b.png"));
  const std::string circle = file("a.png") + ": found symbolic links in a circle, expected a file";
  expect_refused("c_minimal " + file("c.voy") + " " + file("a.png"), 4, circle);
  expect_refused("voyager render " + file("c.voy") + " --backend cpu -o " + file("a.png"), 4,
                 circle);
}

// A scene that is not there: what is said first is what was found out first.
TEST_F(Outputs, TheSampleFindsAnUnwritableOutputBeforeTheWork) {
  expect_refused("c_minimal " + file("absent.voy") + " " + file("no/such/o.png"), 4,
                 file("no/such/o.png"));
}

}  // namespace
}  // namespace voyager::outputs_test
