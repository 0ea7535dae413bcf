// What a user sees of a bake in cells: kills, standard input, steps, refusals.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/command_line/program.h"
#include "tests/support/test_support.h"
#include "tests/support/tree_rules.h"

namespace voyager::test {
namespace bake_in_parts_test {
namespace {

// The least that cells of the default rule can be made of; kills at any moment and full disks, on
// cells of fewer, are tests/property/bake_killed_test.cpp's.
class BakeInParts : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = new TempFolder;
    failure_ = failure_of(
        {"voyager synth city --gaussians 262144 --sh-degree 0 -o " + made_->file("city.ply")});
  }
  static void TearDownTestSuite() { delete made_; }
  void SetUp() override { ASSERT_EQ(failure_, ""); }

  static inline TempFolder* made_ = nullptr;
  static inline std::string failure_;
  TempFolder folder;
  const std::string city = made_->file("city.ply"), scene = folder.file("parts.voy"),
                    work = folder.file("work");
  const std::string bake = "voyager bake " + city + " -o " + scene + " --work " + work;
};

TEST_F(BakeInParts, GoesOnWithoutItsInputAfterAKill) {
  const std::string from_stdin = program("voyager bake - -o " + scene + " --work " + work);
  const Outcome split = run_shell("cat " + city + " | " + from_stdin + " --step split");
  ASSERT_EQ(split.exit_code, 0) << split.output;
  EXPECT_EQ(run_shell("timeout -s KILL 1 " + from_stdin + " < /dev/null").exit_code, 137);
  EXPECT_FALSE(std::filesystem::exists(scene));
  const Outcome again = run_shell(from_stdin + " --step split < /dev/null");
  EXPECT_EQ(again.exit_code, 0) << again.output;
}

// Two bakes of half a minute: scripts/check.sh searches. Of smaller cells, and under sanitizers, it
// is tests/property/bake_in_parts_test.cpp's.
TEST_F(BakeInParts, GivesTheBytesOfABakeInMemoryFromStandardInputAndAfterAKill) {
  if (!whole_paths()) GTEST_SKIP() << "takes a minute: VOYAGER_WHOLE_PATHS=1";
  const Outcome whole = run("voyager bake " + city + " -o " + folder.file("whole.voy"));
  ASSERT_EQ(whole.exit_code, 0) << whole.output;
  EXPECT_EQ(whole.output.find(" cells"), std::string::npos) << whole.output;

  const std::string from_stdin = program("voyager bake - -o " + scene + " --work " + work);
  const Outcome split = run_shell("cat " + city + " | " + from_stdin + " --step split");
  ASSERT_EQ(split.exit_code, 0) << split.output;
  EXPECT_EQ(run_shell("timeout -s KILL 1 " + from_stdin + " < /dev/null").exit_code, 137);
  EXPECT_FALSE(std::filesystem::exists(scene));
  const Outcome merged = run_shell(from_stdin + " < /dev/null");
  ASSERT_EQ(merged.exit_code, 0) << merged.output;
  EXPECT_NE(merged.output.find("262144 Gaussians"), std::string::npos) << merged.output;
  EXPECT_NE(merged.output.find(" in 4 cells"), std::string::npos) << merged.output;
  EXPECT_TRUE(file_bytes(scene) == file_bytes(folder.file("whole.voy")));
  EXPECT_FALSE(std::filesystem::exists(work));
}

TEST_F(BakeInParts, ASceneBeyondTheMemoryIsBakedFromAFolderOfItsOwn) {
  const std::string plain = "voyager bake " + city + " -o " + scene + " --memory 60";
  for (const std::string option : {"--verify", "--tree hierarchicalgs"}) {
    const Outcome refused = run(plain + " " + option);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.output.find(option + ": found a bake in a work folder"), std::string::npos)
        << refused.output;
    EXPECT_FALSE(std::filesystem::exists(scene + ".work"));
  }
  EXPECT_EQ(run_shell("timeout -s KILL 2 " + program(plain)).exit_code, 137);
  EXPECT_TRUE(std::filesystem::exists(scene + ".work"));
}

TEST_F(BakeInParts, AFullDiskSaysWhatIsNeededAndWhere) {
  // Files larger than so many blocks cannot be written.
  const Outcome full = run_shell("ulimit -f 100; " + program(bake));
  EXPECT_EQ(full.exit_code, 4) << full.output;
  for (const std::string& part : {work, std::string("a copy of the inputs takes 15 MB")})
    EXPECT_NE(full.output.find(part), std::string::npos) << full.output;
  EXPECT_FALSE(std::filesystem::exists(scene));
  EXPECT_EQ(run(bake + " --step split").exit_code, 0);
}

TEST_F(BakeInParts, MemoryThatIsRefusedLeavesTheFolderToGoOnFrom) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "AddressSanitizer needs more address space than the test allows the tool";
#endif
  // From kilobytes in which the tool starts up to those in which it ends; each is refused on the
  // way.
  int refusals = 0;
  for (int kilobytes = 40000; kilobytes < 4000000; kilobytes += kilobytes / 6) {
    const Outcome outcome = run_shell("ulimit -v " + std::to_string(kilobytes) + "; " +
                                      program(bake + " --step split"));
    if (outcome.exit_code == 0) break;
    if (outcome.output.find("error while loading shared libraries") != std::string::npos) continue;
    ++refusals;
    EXPECT_EQ(outcome.exit_code, 4) << kilobytes << " KB: " << outcome.output;
    EXPECT_NE(outcome.output.find("voyager: "), std::string::npos) << outcome.output;
  }
  EXPECT_GT(refusals, 0);
  EXPECT_EQ(run(bake + " --step split").exit_code, 0);
}

TEST_F(BakeInParts, StepsAreRefusedWithoutAFolderAndBeforeTheirTime) {
  const std::string plain = "voyager bake " + city + " -o " + scene;
  for (const std::string& command :
       {plain + " --step split", bake + " --step cells", bake + " --step merge",
        bake + " --step encode --part 3/3", bake + " --part x", bake + " --step every",
        bake + " --memory 1", bake + " --tree hierarchicalgs"}) {
    const Outcome refused = run(command);
    EXPECT_EQ(refused.exit_code, 1) << command << refused.output;
  }
  EXPECT_FALSE(std::filesystem::exists(scene));
}

}  // namespace
}  // namespace bake_in_parts_test
}  // namespace voyager::test
