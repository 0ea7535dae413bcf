// What a user sees of a scene that is streamed.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/command_line/program.h"
#include "tests/support/test_support.h"

namespace voyager::test {
namespace streaming_test {
namespace {

class Streaming : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    failure_ = failure_of({"voyager synth city --gaussians 60000 --sh-degree 1 -o " + file("c.ply"),
                           "voyager bake " + file("c.ply") + " -o " + file("c.voy"),
                           render("c.voy", "-o " + file("whole.pfm"))});
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { ASSERT_EQ(failure_, ""); }

  static std::string file(const std::string& name) { return folder_->file(name); }
  static std::string render(const std::string& scene, const std::string& rest) {
    return "voyager render " + file(scene) + " --cameras " + file("c.cameras.json") +
           " --backend cpu --camera 10 --size 96x54 " + rest;
  }
  // c.voy with a byte of its chunks changed.
  static void damage(const std::string& name, double place) {
    std::string bytes = file_bytes(file("c.voy"));
    bytes[static_cast<size_t>(place * static_cast<double>(bytes.size()))] ^= 0x40;
    write_bytes(file(name), bytes);
  }

  static inline TempFolder* folder_ = nullptr;
  static inline std::string failure_;
};

TEST_F(Streaming, AFrameThatWaitsIsThatOfTheWholeScene) {
  for (const std::string& how :
       {std::string("--budget 40 --wait-resident on"), std::string("--wait-resident on"),
        std::string("--budget 40 --keep-going")}) {
    const Outcome drawn = run(render("c.voy", how + " -o " + file("part.pfm")));
    ASSERT_EQ(drawn.exit_code, 0) << drawn.output;
    EXPECT_TRUE(file_bytes(file("part.pfm")) == file_bytes(file("whole.pfm"))) << how;
  }
}

TEST_F(Streaming, WithoutWaitingASmallBudgetDrawsACoarserImage) {
  const Outcome drawn =
      run(render("c.voy", "--budget 2 -o " + file("small.pfm") + " --stats " + file("s.json")));
  ASSERT_EQ(drawn.exit_code, 0) << drawn.output;
  EXPECT_EQ(file_bytes(file("small.pfm")).size(), file_bytes(file("whole.pfm")).size());
  EXPECT_FALSE(file_bytes(file("small.pfm")) == file_bytes(file("whole.pfm")));
}

TEST_F(Streaming, ABudgetOfAFewBytesIsSaidAsItWasGiven) {
  for (const std::string budget : {"0.000001", "0.000003", "0.0002"}) {
    const Outcome refused = run(render("c.voy", "--budget " + budget + " -o " + file("o.pfm")));
    EXPECT_EQ(refused.exit_code, 4);
    EXPECT_NE(refused.output.find("the memory budget allows " + budget), std::string::npos)
        << refused.output;
  }
}

// The megabytes that a refusal names are enough for the same frame.
TEST_F(Streaming, ARefusedBudgetSaysWhatIsEnough) {
  const std::string wait = " --wait-resident on -o " + file("fits.pfm");
  const Outcome refused = run(render("c.voy", "--budget 2" + wait));
  EXPECT_EQ(refused.exit_code, 4) << refused.output;
  const size_t expected = refused.output.find("expected ");
  ASSERT_NE(expected, std::string::npos) << refused.output;
  const std::string enough =
      refused.output.substr(expected + 9, refused.output.find(' ', expected + 9) - expected - 9);
  ASSERT_EQ(run(render("c.voy", "--budget " + enough + wait)).exit_code, 0) << enough;
  EXPECT_TRUE(file_bytes(file("fits.pfm")) == file_bytes(file("whole.pfm")));
  const Outcome top = run(render("c.voy", "--budget 0.001 -o " + file("none.pfm")));
  EXPECT_EQ(top.exit_code, 4) << top.output;
  EXPECT_NE(top.output.find("the top of the tree takes "), std::string::npos) << top.output;
  EXPECT_EQ(std::count(top.output.begin(), top.output.end(), '\n'), 1) << top.output;
  EXPECT_FALSE(std::filesystem::exists(file("none.pfm")));
}

TEST_F(Streaming, DamageIsRefusedOrStoodInFor) {
  damage("bad.voy", 0.5);
  const std::string all = " --tau 0 -o " + file("bad.pfm");
  const Outcome refused = run(render("bad.voy", "--wait-resident on" + all));
  EXPECT_EQ(refused.exit_code, 3) << refused.output;
  EXPECT_NE(refused.output.find("bad.voy: chunk "), std::string::npos) << refused.output;
  EXPECT_FALSE(std::filesystem::exists(file("bad.pfm")));
  const Outcome going = run(render("bad.voy", "--keep-going" + all));
  EXPECT_EQ(going.exit_code, 0) << going.output;
  EXPECT_NE(going.output.find("bad.voy: chunk "), std::string::npos) << going.output;
  EXPECT_TRUE(std::filesystem::exists(file("bad.pfm")));
}

TEST_F(Streaming, WhatItHasNoMeaningForIsRefused) {
  for (const std::string& rest :
       {std::string("--budget 40 --lod off"), std::string("--budget 40 --search exhaustive"),
        std::string("--budget nan"), std::string("--budget -1"), std::string("--budget 1e300"),
        std::string("--wait-resident perhaps")}) {
    const Outcome refused = run(render("c.voy", rest + " -o " + file("no.pfm")));
    EXPECT_EQ(refused.exit_code, 1) << rest << "\n" << refused.output;
    EXPECT_EQ(std::count(refused.output.begin(), refused.output.end(), '\n'), 1) << refused.output;
    EXPECT_FALSE(std::filesystem::exists(file("no.pfm")));
  }
}

}  // namespace
}  // namespace streaming_test
}  // namespace voyager::test
