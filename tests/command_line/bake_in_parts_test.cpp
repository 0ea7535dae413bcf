// What a user sees of a bake in cells: kills, standard input, steps, refusals.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::test {
namespace {

class BakeInParts : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(failure_of({"voyager synth city --gaussians 20000 --sh-degree 1 -o " + city,
                          "voyager bake " + city + " -o " + folder.file("whole.voy")}),
              "");
    whole = file_bytes(folder.file("whole.voy"));
    ASSERT_FALSE(whole.empty());
  }

  TempFolder folder;
  const std::string city = folder.file("city.ply"), scene = folder.file("parts.voy"),
                    work = folder.file("work");
  const std::string bake = "voyager bake " + city + " -o " + scene + " --work " + work;
  std::string whole;
};

TEST_F(BakeInParts, GivesTheSameBytesAndRemovesItsFolder) {
  const Outcome baked = run(bake);
  ASSERT_EQ(baked.exit_code, 0) << baked.output;
  EXPECT_NE(baked.output.find("20000 Gaussians"), std::string::npos) << baked.output;
  EXPECT_NE(baked.output.find(" cells"), std::string::npos) << baked.output;
  EXPECT_TRUE(file_bytes(scene) == whole);
  EXPECT_FALSE(std::filesystem::exists(work));
}

TEST_F(BakeInParts, GoesOnAfterAKillAtAnyMoment) {
  int kills = 0;
  for (int round = 0; round < 3; ++round) {
    std::filesystem::remove(scene);
    Outcome baked{137, ""};
    for (int wait = 10 + 7 * round; baked.exit_code == 137; wait += 12) {
      char seconds[16];
      std::snprintf(seconds, sizeof seconds, "0.%03d", wait);
      const std::string timed = std::string("timeout -s KILL ") + seconds + " ";
      baked = run_shell(timed + program(bake));
      kills += baked.exit_code == 137;
      if (std::filesystem::exists(scene)) {
        ASSERT_TRUE(file_bytes(scene) == whole);
      }
    }
    ASSERT_EQ(baked.exit_code, 0) << baked.output;
    ASSERT_TRUE(file_bytes(scene) == whole);
    ASSERT_FALSE(std::filesystem::exists(work));
  }
  EXPECT_GT(kills, 3);
}

TEST_F(BakeInParts, TakesStandardInput) {
  const std::string from_stdin = program("voyager bake - -o " + scene + " --work " + work);
  const Outcome split = run_shell("cat " + city + " | " + from_stdin + " --step split");
  ASSERT_EQ(split.exit_code, 0) << split.output;
  const Outcome merged = run_shell(from_stdin + " < /dev/null");
  ASSERT_EQ(merged.exit_code, 0) << merged.output;
  EXPECT_TRUE(file_bytes(scene) == whole);
}

TEST_F(BakeInParts, ASceneBeyondTheMemoryIsBakedFromAFolderOfItsOwn) {
  const std::string large = folder.file("large.ply");
  ASSERT_EQ(failure_of({"voyager synth city --gaussians 120000 --sh-degree 0 -o " + large,
                        "voyager bake " + large + " -o " + folder.file("large.voy")}),
            "");
  const Outcome baked = run("voyager bake " + large + " -o " + scene + " --memory 20");
  ASSERT_EQ(baked.exit_code, 0) << baked.output;
  EXPECT_NE(baked.output.find(" cells"), std::string::npos) << baked.output;
  EXPECT_TRUE(file_bytes(scene) == file_bytes(folder.file("large.voy")));
  EXPECT_FALSE(std::filesystem::exists(scene + ".work"));

  const Outcome verify = run("voyager bake " + large + " -o " + scene + " --memory 20 --verify");
  EXPECT_EQ(verify.exit_code, 1);
  EXPECT_NE(verify.output.find("--verify"), std::string::npos) << verify.output;
  EXPECT_FALSE(std::filesystem::exists(scene + ".work"));
}

TEST_F(BakeInParts, AFullDiskSaysWhatIsNeededAndWhere) {
  // Files larger than so many blocks cannot be written.
  const Outcome full = run_shell("ulimit -f 100; " + program(bake));
  EXPECT_EQ(full.exit_code, 4) << full.output;
  for (const std::string& part : {work, std::string("a copy of the inputs takes 2 MB")})
    EXPECT_NE(full.output.find(part), std::string::npos) << full.output;
  EXPECT_FALSE(std::filesystem::exists(scene));
  ASSERT_EQ(run(bake).exit_code, 0);
  EXPECT_TRUE(file_bytes(scene) == whole);
}

TEST_F(BakeInParts, MemoryThatIsRefusedLeavesTheFolderToGoOnFrom) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "AddressSanitizer needs more address space than the test allows the tool";
#endif
  const Outcome refused = run_shell("ulimit -v 200000; " + program(bake));
  if (refused.exit_code != 0) {
    EXPECT_EQ(refused.exit_code, 4) << refused.output;
    EXPECT_NE(refused.output.find("voyager: "), std::string::npos) << refused.output;
    ASSERT_EQ(run(bake).exit_code, 0);
  }
  EXPECT_TRUE(file_bytes(scene) == whole);
}

TEST_F(BakeInParts, StepsAreRefusedWithoutAFolderAndBeforeTheirTime) {
  const std::string plain = "voyager bake " + city + " -o " + scene;
  for (const std::string& command :
       {plain + " --step split", bake + " --step cells", bake + " --step merge",
        bake + " --step encode --part 3/3", bake + " --part x", bake + " --step all",
        bake + " --memory 1"}) {
    const Outcome refused = run(command);
    EXPECT_EQ(refused.exit_code, 1) << command << refused.output;
  }
  EXPECT_FALSE(std::filesystem::exists(scene));
}

}  // namespace
}  // namespace voyager::test
