// What is written, read by another program: splat-transform, where it is
// installed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/command_line/program.h"
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

// Reordered, so that sorted coordinates are compared: those differ by no more
// than the coordinates.
TEST_F(OtherTools, ReadACompressedPly) {
  const GaussianCloud city = import_file(file("c.ply"));
  const GaussianCloud back = there_and_back(".compressed.ply");
  ASSERT_EQ(back.size(), city.size());
  EXPECT_EQ(back.sh_degree, 1);
  for (const size_t axis : {0, 1, 2}) {
    std::vector<float> a, b;
    for (size_t i = 0; i < city.size(); ++i) {
      a.push_back(city.position[3 * i + axis]);
      b.push_back(back.position[3 * i + axis]);
    }
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    const float width = a.back() - a.front();
    for (size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], width / 2046) << axis;
  }
}

}  // namespace
}  // namespace voyager::other_tools_test
