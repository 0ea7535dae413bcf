// What is written, read by another program: splat-transform, where it is
// installed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/command_line/program.h"
#include "tests/support/lcc_files.h"
#include "tests/support/needs.h"
#include "tests/support/sample_files.h"
#include "tests/support/test_support.h"

namespace voyager::other_tools_test {
namespace {

using namespace voyager::test;

class OtherTools : public ::testing::Test {
 protected:
  void SetUp() override {
    if (run_shell("command -v splat-transform").exit_code != 0)
      VOYAGER_SKIP_WITHOUT(SPLAT_TRANSFORM,
                           "splat-transform is not here: npm install -g "
                           "@playcanvas/splat-transform");
    ASSERT_EQ(
        failure_of({"voyager synth city --gaussians 10000 --sh-degree 1 -o " + file("c.ply")}), "");
  }
  std::string file(const std::string& name) const { return folder_.file(name); }

  // Through the format and the other program.
  GaussianCloud there_and_back(const std::string& ending, const std::string& options = "") {
    const std::string out = file("out" + ending), back = file("back.ply");
    const Outcome ours = run("voyager convert " + file("c.ply") + " -o " + out + options);
    EXPECT_EQ(ours.exit_code, 0) << ours.output;
    const Outcome theirs = run_shell("splat-transform -q -w " + out + " " + back);
    EXPECT_EQ(theirs.exit_code, 0) << theirs.output;
    return import_file(back);
  }

 private:
  TempFolder folder_;
};

float largest_difference(const std::pmr::vector<float>& a, const std::pmr::vector<float>& b) {
  if (a.size() != b.size()) return INFINITY;
  float largest = 0;
  for (size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::fabs(a[i] - b[i]));
  return largest;
}

float largest_opacity_difference(const GaussianCloud& a, const GaussianCloud& b) {
  if (a.size() != b.size()) return INFINITY;
  float largest = 0;
  for (size_t i = 0; i < a.size(); ++i)
    largest = std::max(largest, std::fabs(sigmoid(a.opacity[i]) - sigmoid(b.opacity[i])));
  return largest;
}

TEST_F(OtherTools, ReadAnSpzWithinHalfAStep) {
  GaussianCloud city = import_file(file("c.ply"));
  for (float& log_scale : city.log_scale) log_scale = std::max(log_scale, -10.0f);  // its least
  for (const char* version : {" --spz-version 3", " --spz-version 4"}) {
    const GaussianCloud back = there_and_back(".spz", version);
    EXPECT_LE(largest_difference(city.position, back.position), 0.501f / 4096);
    EXPECT_LE(largest_difference(city.log_scale, back.log_scale), 0.501f / 16);
    EXPECT_LE(largest_opacity_difference(city, back), 0.501f / 255);
    EXPECT_LE(largest_difference(city.sh, back.sh), 0.501f / 255 / 0.15f);
  }
}

TEST_F(OtherTools, ReadASplatWithinHalfAStep) {
  const GaussianCloud city = import_file(file("c.ply"));
  const GaussianCloud back = there_and_back(".splat");
  EXPECT_EQ(back.sh_degree, 0);
  EXPECT_EQ(largest_difference(city.position, back.position), 0);
  EXPECT_LE(largest_difference(city.log_scale, back.log_scale), 1e-6f);
  EXPECT_LE(largest_opacity_difference(city, back), 0.501f / 255);
}

std::vector<float> sorted_coordinates(const GaussianCloud& cloud, size_t axis) {
  std::vector<float> coordinates;
  for (size_t i = axis; i < cloud.position.size(); i += 3) coordinates.push_back(cloud.position[i]);
  std::sort(coordinates.begin(), coordinates.end());
  return coordinates;
}

// Reordered, so that sorted coordinates are compared: those differ by no more
// than the coordinates.
TEST_F(OtherTools, ReadACompressedPly) {
  const GaussianCloud city = import_file(file("c.ply"));
  const GaussianCloud back = there_and_back(".compressed.ply");
  ASSERT_EQ(back.size(), city.size());
  EXPECT_EQ(back.sh_degree, 1);
  for (const size_t axis : {0, 1, 2}) {
    const std::vector<float> a = sorted_coordinates(city, axis), b = sorted_coordinates(back, axis);
    const float width = a.back() - a.front();
    for (size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], width / 2046) << axis;
  }
}

// The same words as our own reader's, which holds its steps (tests/unit/scene/sog_export_test.cpp).
TEST_F(OtherTools, ReadASogAsWeDo) {
  if (!VOYAGER_SOG) GTEST_SKIP() << "this build leaves SOG out";
  const GaussianCloud theirs = there_and_back(".sog");
  const GaussianCloud ours = import_file(file("out.sog"));
  ASSERT_EQ(theirs.size(), 10000u);
  EXPECT_EQ(theirs.sh_degree, 1);
  EXPECT_LE(largest_difference(theirs.log_scale, ours.log_scale), 1e-5f);
  EXPECT_LE(largest_opacity_difference(theirs, ours), 1e-5f);
  EXPECT_LE(largest_difference(theirs.sh, ours.sh), 1e-5f);
  for (size_t i = 0; i < ours.position.size(); ++i)
    ASSERT_NEAR(theirs.position[i], ours.position[i], 1e-5 * (1 + std::fabs(ours.position[i])));
}

// Made by hand: its finest level. splat-transform goes by the counts of the .lcc.
TEST_F(OtherTools, ReadAnLccAsWeDo) {
  LccFiles files = lcc_files(true);
  nlohmann::json meta = lcc_meta(2, true);
  meta["splats"] = {5, 2};
  files["scene.lcc"] = bytes_of(meta.dump());
  for (const auto& [name, bytes] : files)
    write_bytes(file(name), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const Outcome outcome =
      run_shell("splat-transform -q -w -O 0 " + file("scene.lcc") + " " + file("back.ply"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const GaussianCloud ours = import_file(file("scene.lcc")), theirs = import_file(file("back.ply"));
  ASSERT_EQ(ours.size(), 5u);
  EXPECT_LE(largest_difference(ours.position, theirs.position), 1e-5f);
  EXPECT_LE(largest_difference(ours.log_scale, theirs.log_scale), 1e-5f);
  EXPECT_LE(largest_opacity_difference(ours, theirs), 1e-5f);
  EXPECT_LE(largest_difference(ours.sh, theirs.sh), 1e-5f);
  for (size_t i = 0; i < ours.size(); ++i) {
    float dot = 0;
    for (size_t k = 0; k < 4; ++k) dot += ours.rotation[4 * i + k] * theirs.rotation[4 * i + k];
    EXPECT_NEAR(std::fabs(dot), 1, 1e-5) << i;
  }
}

}  // namespace
}  // namespace voyager::other_tools_test
