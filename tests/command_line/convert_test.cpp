// From one format to another, and a share of a tree as a flat file.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::convert_command_test {
namespace {

using namespace voyager::test;
namespace fs = std::filesystem;

class ConvertCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    failure_ = failure_of({"voyager synth city --gaussians 10000 --sh-degree 1 -o " + file("c.ply"),
                           "voyager bake " + file("c.ply") + " -o " + file("c.voy")});
    fs::create_symlink("/dev/full", file("full.glb"));
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { ASSERT_EQ(failure_, ""); }
  static std::string file(const std::string& name) { return folder_->file(name); }

  static inline TempFolder* folder_ = nullptr;
  static inline std::string failure_;
};

const std::string kEndings[] = {".compressed.ply", ".ply", ".spz", ".splat", ".glb"};

TEST_F(ConvertCommand, WritesEveryFormatFromFlatAndBakedScenes) {
  for (const std::string& ending : kEndings)
    for (const std::string& command :
         {"convert " + file("c.ply"), "convert " + file("c.voy"), "export " + file("c.voy")}) {
      const std::string out = file("out" + ending);
      fs::remove(out);
      const Outcome done = run("voyager " + command + " -o " + out);
      EXPECT_EQ(done.exit_code, 0) << done.output;
      EXPECT_NE(done.output.find(out + ": 10000 Gaussians of SH degree "), std::string::npos)
          << done.output;
      EXPECT_TRUE(fs::exists(out));
      EXPECT_EQ(done.output.find("spherical harmonics") != std::string::npos, ending == ".splat")
          << done.output;
    }
}

TEST_F(ConvertCommand, WritesASogOrSaysThatTheBuildLeavesItOut) {
  const std::string out = file("out.sog");
  const Outcome done = run("voyager convert " + file("c.ply") + " -o " + out);
  EXPECT_EQ(done.exit_code == 0, VOYAGER_SOG == 1) << done.output;
  EXPECT_EQ(fs::exists(out), VOYAGER_SOG == 1);
  const std::string says =
      VOYAGER_SOG ? out + ": 10000 Gaussians" : "libvoyager_sog.so: not found in ";
  EXPECT_NE(done.output.find(says), std::string::npos) << done.output;
}

TEST_F(ConvertCommand, APlyComesBackToTheBit) {
  ASSERT_EQ(run("voyager convert " + file("c.ply") + " -o " + file("same.ply")).exit_code, 0);
  EXPECT_EQ(file_bytes(file("same.ply")), file_bytes(file("c.ply")));
}

// The second input is the first, moved before.
TEST_F(ConvertCommand, JoinsInputsEachInItsPlace) {
  const std::string convert = "voyager convert " + file("c.ply");
  ASSERT_EQ(run(convert + " -o " + file("moved.ply") +
                " --up z --transform 'scale 2, rotate 0 1 0 90, translate 5 0 -7'")
                .exit_code,
            0);
  ASSERT_EQ(run(convert + " " + file("moved.ply") + " -o " + file("by_hand.ply")).exit_code, 0);
  const Outcome joined = run(convert + " " + file("c.ply") + " -o " + file("joined.ply") +
                             " --up -y --up z --transform 'translate 0 0 0' --transform "
                             "'scale 2, rotate 0 1 0 90, translate 5 0 -7'");
  ASSERT_EQ(joined.exit_code, 0) << joined.output;
  EXPECT_NE(joined.output.find("20000 Gaussians"), std::string::npos) << joined.output;
  EXPECT_EQ(file_bytes(file("joined.ply")), file_bytes(file("by_hand.ply")));
}

TEST_F(ConvertCommand, AnSpzHasTheVersionThatIsAskedFor) {
  const std::string convert = "voyager convert " + file("c.ply") + " -o " + file("v.spz");
  ASSERT_EQ(run(convert + " --spz-version 3").exit_code, 0);
  EXPECT_EQ(file_bytes(file("v.spz")).substr(0, 2), "\x1f\x8b");
  ASSERT_EQ(run(convert).exit_code, 0);
  EXPECT_EQ(file_bytes(file("v.spz")).substr(0, 4), "NGSP");
}

TEST_F(ConvertCommand, KeepTakesAShareOrACount) {
  for (const std::string& keep : {std::string("25%"), std::string("2500")})
    for (const char* command : {"convert", "export"}) {
      const Outcome done = run(std::string("voyager ") + command + " " + file("c.voy") + " -o " +
                               file("kept.spz") + " --keep " + keep);
      ASSERT_EQ(done.exit_code, 0) << done.output;
      const size_t at = done.output.rfind("kept.spz: ") + 10;  // after the notes
      const int kept = std::stoi(done.output.substr(at));
      EXPECT_LE(kept, 2500);
      EXPECT_GT(kept, 2400) << done.output;
    }
}

TEST_F(ConvertCommand, AGlbIsCompressedWithSpzInside) {
  const Outcome done =
      run("voyager convert " + file("c.ply") + " -o " + file("small.glb") + " --spz");
  ASSERT_EQ(done.exit_code, 0) << done.output;
  ASSERT_EQ(run("voyager convert " + file("c.ply") + " -o " + file("whole.glb")).exit_code, 0);
  EXPECT_LT(file_bytes(file("small.glb")).size(), file_bytes(file("whole.glb")).size() / 3);
  ASSERT_EQ(run("voyager convert " + file("small.glb") + " -o " + file("small.ply")).exit_code, 0);
}

// The tree of a .hier stays, through a lossless scene and back; another is built when asked for.
TEST_F(ConvertCommand, AHierKeepsItsTree) {
  const auto voyager = [](const std::string& command) { return run("voyager " + command); };
  const std::string bake = "bake " + file("a.hier") + " -o " + file("a.voy");
  ASSERT_EQ(voyager("export " + file("c.voy") + " -o " + file("a.hier")).exit_code, 0);
  const Outcome baked = voyager(bake + " --quality lossless --verify");
  ASSERT_EQ(baked.exit_code, 0) << baked.output;
  ASSERT_EQ(voyager("export " + file("a.voy") + " -o " + file("b.hier")).exit_code, 0);
  EXPECT_EQ(file_bytes(file("b.hier")), file_bytes(file("a.hier")));
  const Outcome kept =
      voyager("convert " + file("a.hier") + " -o " + file("kept.ply") + " --keep 25%");
  ASSERT_EQ(kept.exit_code, 0) << kept.output;
  EXPECT_NE(kept.output.find(" % of 10000 leaves"), std::string::npos) << kept.output;
  EXPECT_EQ(voyager(bake + " --tree clustered").exit_code, 0);
  const Outcome refused = voyager(bake + " --refine 4");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.output.find("--refine: found " + file("a.hier")), std::string::npos);
}

TEST_F(ConvertCommand, ATilesetOfATreeIsReadBack) {
  fs::create_directory(file("tiles"));
  ASSERT_EQ(run("voyager convert " + file("c.ply") + " -o " + file("tiles/mine.ply")).exit_code, 0);
  for (const std::string options : {"", " --spz"}) {
    const Outcome done =
        run("voyager export " + file("c.voy") + " -o " + file("tiles/tileset.json") + options);
    ASSERT_EQ(done.exit_code, 0) << done.output;
    EXPECT_NE(done.output.find(": 1 tile, 10000 leaves as "), std::string::npos) << done.output;
    const Outcome back =
        run("voyager convert " + file("tiles/tileset.json") + " -o " + file("back.ply"));
    EXPECT_NE(back.output.find("back.ply: 10000 Gaussians"), std::string::npos) << back.output;
  }
  EXPECT_TRUE(fs::exists(file("tiles/mine.ply")));
  const Outcome refused =
      run("voyager export " + file("c.voy") + " -o " + file("none/tileset.json") + " --keep 25%");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_FALSE(fs::exists(file("none")));
}

// Whenever it is killed: the file of before, or the whole new one, and nothing beside it.
TEST_F(ConvertCommand, AKilledOneLeavesTheFileOfBefore) {
  const std::string folder = file("killed"), out = folder + "/out.spz";
  fs::create_directories(folder);
  if (const int unnamed = ::open(folder.c_str(), O_TMPFILE | O_RDWR, 0600); unnamed >= 0)
    ::close(unnamed);
  else
    GTEST_SKIP() << "this file system has no files without a name";
  ASSERT_EQ(run("voyager convert " + file("c.ply") + " -o " + file("whole.spz")).exit_code, 0);
  const std::string whole = file_bytes(file("whole.spz"));
  for (int milliseconds = 5; milliseconds < 80; milliseconds += 15) {
    write_bytes(out, "before");
    run_shell("timeout -s KILL 0.0" + std::string(milliseconds < 10 ? "0" : "") +
              std::to_string(milliseconds) + " " +
              program("voyager convert " + file("c.ply") + " -o " + out));
    const std::string found = file_bytes(out);
    EXPECT_TRUE(found == "before" || found == whole) << milliseconds << " ms";
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
  }
}

TEST_F(ConvertCommand, EndingsMayBeInCapitals) {
  ASSERT_EQ(run("voyager convert " + file("c.ply") + " -o " + file("OUT.PLY")).exit_code, 0);
  EXPECT_EQ(file_bytes(file("OUT.PLY")), file_bytes(file("c.ply")));
  const Outcome done = run("voyager convert " + file("OUT.PLY") + " -o " + file("Out.Spz"));
  EXPECT_EQ(done.exit_code, 0) << done.output;
  EXPECT_EQ(file_bytes(file("Out.Spz")).substr(0, 4), "NGSP");
}

TEST_F(ConvertCommand, RefusesWhatItCannotDoAndSaysWhatItExpects) {
  const std::string flat = "convert " + file("c.ply"), baked = "export " + file("c.voy");
  const struct {
    std::string command;
    int code;
    std::string says;
  } table[] = {
      {flat + " -o " + file("c.foo"), 1, "-o: found " + file("c.foo") + ", expected a name that"},
      {flat + " -o " + file("c.ply"), 1, "as an output and as an input"},
      {flat + " -o " + file("c.hier"), 1, "expected a name that ends in .compressed.ply or .ply"},
      {flat + " -o " + file("full.glb"), 4, "found a terminal"},
      {flat + " -o " + file("no/such.spz"), 4, file("no/such.spz")},
      {flat + " -o " + file("k.ply") + " --keep 25%", 1, "--keep: found " + file("c.ply")},
      {flat + " -o " + file("k.ply") + " --spz-version 3", 1, "--spz-version: found -o "},
      {flat + " -o " + file("k.glb") + " --spz-version 3", 1, "--spz-version: found -o "},
      {flat + " -o " + file("k.spz") + " --spz", 1, ", expected a name that ends in .glb\n"},
      {flat + " -o " + file("tileset.json") + " --spz", 1, "-o: found " + file("tileset.json")},
      {baked + " -o " + file("k.spz") + " --spz", 1, "ends in .glb, or tileset.json\n"},
      {"convert " + file("") + " -o " + file("k.ply"), 2,
       "found a directory, expected a file, or a folder with lod-meta.json, meta.json or tileset."},
      {flat + " -o " + file("k.spz") + " --spz-version 5", 1, "--spz-version: found 5"},
      {"convert " + file("absent.ply") + " -o " + file("k.ply"), 2, "absent.ply"},
      {"convert " + file("c.cameras.json") + " -o " + file("k.ply"), 2,
       "expected a .voy, or a .ply"},
      {"convert - -o " + file("k.ply"), 1, "found standard input"},
      {flat + " - -o " + file("k.ply"), 1, "found standard input"},
      {flat + " " + file("c.voy") + " -o " + file("k.ply"), 1, "c.voy and other inputs, expected"},
      {"convert " + file("c.voy") + " -o " + file("k.ply") + " --up z", 1, "--up, --transform: f"},
      {flat + " " + file("c.spz") + " -o " + file("c.spz"), 1, "as an output and as an input"},
      {flat + " -o " + file("k.ply") + " --up z --up y", 1, "--up: found 2 of them, expected one"},
      {flat + " " + file("c.ply") + " " + file("c.ply") + " -o " + file("k.ply") +
           " --transform 'scale 2' --transform 'scale 3'",
       1, "one for each of the 3 inputs"},
      {baked + " -o " + file("k.hier") + " --keep 25%", 1, "--keep: found -o "},
      {baked + " -o " + file("k.ply") + " --keep 0%", 1, "--keep: found 0%, expected a share"},
      {baked + " -o " + file("k.ply") + " --keep 101%", 1, "--keep: found 101%"},
      {baked + " -o " + file("k.ply") + " --keep 2.5", 1, "--keep: found 2.5"},
  };
  for (const auto& [command, code, says] : table) {
    const Outcome refused = run("voyager " + command);
    EXPECT_EQ(refused.exit_code, code) << command << "\n" << refused.output;
    EXPECT_NE(refused.output.find(says), std::string::npos) << says << "\n" << refused.output;
    EXPECT_EQ(std::count(refused.output.begin(), refused.output.end(), '\n'), 1) << refused.output;
  }
  EXPECT_FALSE(fs::exists(file("k.ply")));
}

}  // namespace
}  // namespace voyager::convert_command_test
