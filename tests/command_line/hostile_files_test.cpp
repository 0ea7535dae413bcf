// Files that claim far more than they hold cost no more than what they hold, whatever reads them.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/hostile_files.h"
#include "tests/support/measured_run.h"
#include "tests/support/sample_files.h"

namespace voyager::test {
namespace hostile_files_test {
namespace {

constexpr uint64_t kClaimed = uint64_t{2133} * 1000 * 1000;  // bytes

class HostileFiles : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    failure_ =
        failure_of({"voyager synth city --gaussians 10000 --sh-degree 0 -o " + file("small.ply"),
                    "voyager bake " + file("small.ply") + " -o " + file("small.voy")});
    for (const std::string& command : commands("small.voy"))
      little_.push_back(run_measured(program(command)));
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { ASSERT_EQ(failure_, ""); }

  static std::string file(const std::string& name) { return folder_->file(name); }
  // Zeros that take no room on the disk behind what is there.
  static void write_sparse(const ClaimedFile& claimed) {
    write_bytes(file("claims.voy"),
                {reinterpret_cast<const char*>(claimed.head.data()), claimed.head.size()});
    std::filesystem::resize_file(file("claims.voy"), claimed.length);
  }
  // Every command that reads a scene.
  static std::vector<std::string> commands(const std::string& scene) {
    const std::string render = "voyager render " + file(scene) + " --backend cpu --cameras " +
                               file("small.cameras.json") + " --camera 0 --size 64x48 -o " +
                               file("out.png");
    return {"voyager info " + file(scene),
            render,
            render + " --wait-resident on",
            render + " --budget 4000",
            "voyager export " + file(scene) + " -o " + file("out.ply"),
            "voyager export " + file(scene) + " -o " + file("out.hier")};
  }
  static void expect_all_refused() {
    const std::vector<std::string> hostile = commands("claims.voy");
    for (size_t i = 0; i < hostile.size(); ++i) {
      SCOPED_TRACE(hostile[i]);
      expect_cheap_refusal(run_measured(program(hostile[i])), little_[i]);
    }
  }

  static inline TempFolder* folder_ = nullptr;
  static inline std::string failure_;
  static inline std::vector<Spent> little_;  // of the commands on a small scene
};

TEST_F(HostileFiles, CompactChunksThatHoldNothing) {
  write_sparse(claimed_chunks(Quality::compact, 100));
  expect_all_refused();
}

TEST_F(HostileFiles, LosslessChunksInAHole) {
  write_sparse(claimed_chunks(Quality::lossless, 600));
  expect_all_refused();
}

TEST_F(HostileFiles, SectionsInAHole) {
  for (const SectionKind which : {SectionKind::tiers, SectionKind::chunk_directory}) {
    write_sparse(claimed_section(which, kClaimed));
    expect_all_refused();
  }
}

// A header of rows that take 2 GB, and none of them.
TEST_F(HostileFiles, RowsInAHole) {
  const std::string small = file_bytes(file("small.ply"));
  std::string header = small.substr(0, small.find("end_header\n") + 11);
  header.replace(header.find("vertex 10000"), 12, "vertex 31000000");
  write_bytes(file("claims.ply"), header);
  std::filesystem::resize_file(file("claims.ply"), header.size() + uint64_t{68} * 31'000'000);
  const std::vector<std::string> little = commands("small.voy"), hostile = commands("claims.ply");
  for (size_t i = 0; i < 2; ++i)
    expect_cheap_refusal(run_measured(program(hostile[i])), little_[i]);
  for (const std::string from : {"", "- < "}) {
    const Spent found = run_measured(
        program("voyager bake -o " + file("claims.voy") + " " + from + file("claims.ply")));
    expect_cheap_refusal(found, little_[0]);
    EXPECT_NE(found.output.find("of data in a file of 2108.0"), std::string::npos) << found.output;
  }
}

TEST_F(HostileFiles, CamerasInAHoleOrWithoutEnd) {
  write_bytes(file("hole.json"), "[1");
  std::filesystem::resize_file(file("hole.json"), 1'000'000'000);
  write_bytes(file("deep.json"), std::string(5'000'000, '['));
  for (const std::string& cameras : {file("hole.json"), file("deep.json")}) {
    const Spent found =
        run_measured(program("voyager render " + file("small.voy") + " --backend cpu --cameras " +
                             cameras + " -o " + file("out.png")));
    expect_cheap_refusal(found, little_[1]);
    EXPECT_NE(found.output.find(cameras + ": found"), std::string::npos) << found.output;
  }
}

TEST_F(HostileFiles, WideRowsOnStandardInput) {
  write_bytes(file("wide.ply"), wide_ply(9000));
  expect_cheap_refusal(
      run_measured(program("voyager bake - -o " + file("wide.voy") + " < " + file("wide.ply"))),
      little_[0]);
  EXPECT_FALSE(std::filesystem::exists(file("wide.voy")));
}

// Forty million zeros in forty thousand bytes.
TEST_F(HostileFiles, CompressedZeros) {
  Bytes bytes = planar_spz(3, 0, 0);
  const uint32_t count = 2'000'000;
  std::memcpy(bytes.data() + 8, &count, sizeof count);
  bytes.resize(16 + size_t{20} * count);
  bytes = gzip(bytes);
  write_bytes(file("zeros.spz"), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const std::vector<std::string> little = commands("small.voy"), hostile = commands("zeros.spz");
  for (size_t i = 0; i < 2; ++i)
    expect_cheap_refusal(run_measured(program(hostile[i])), run_measured(program(little[i])));
  const std::string bake = "voyager bake -o " + file("zeros.voy") + " ";
  expect_cheap_refusal(run_measured(program(bake + file("zeros.spz"))),
                       run_measured(program(bake + file("small.ply"))));
}

// Nobody writes to the FIFO, and the terminal is one that nobody types on.
TEST_F(HostileFiles, WhatIsNoFileIsRefusedByName) {
  ASSERT_EQ(run_shell("mkfifo " + file("fifo.voy")).exit_code, 0);
  for (const auto& [path, name] :
       {std::pair(file("fifo.voy"), "a FIFO"),
        std::pair(std::string("/dev/zero"), "character device"),
        std::pair(std::string("/dev/ptmx"), "a terminal"), std::pair(file("."), "a directory")})
    for (const std::string& command :
         {std::string("info "), "bake -o " + file("out.voy "), "export -o " + file("out.ply ")}) {
      const Outcome found = run_shell("timeout 10 " + program("voyager " + command + path));
      EXPECT_EQ(found.exit_code, 2) << found.output;
      EXPECT_NE(found.output.find(name), std::string::npos) << found.output;
    }
}

}  // namespace
}  // namespace hostile_files_test
}  // namespace voyager::test
