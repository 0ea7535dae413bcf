// Several inputs of a bake become one cloud.
#include "runtime/scene/append.h"

#include "runtime/base/error.h"
#include "tests/support/test_support.h"

namespace voyager::test {
namespace append_test {
namespace {

TEST(Append, KeepsEveryWordInTheOrderOfTheInputs) {
  const GaussianCloud first = random_cloud(7, 1), second = random_cloud(5, 2);
  GaussianCloud sum = first;
  append(sum, GaussianCloud(second), "second.ply");
  ASSERT_EQ(sum.size(), 12u);
  for (size_t i = 0; i < 7; ++i) EXPECT_EQ(sum.opacity[i], first.opacity[i]);
  for (size_t i = 0; i < 5; ++i) EXPECT_EQ(sum.opacity[7 + i], second.opacity[i]);
  EXPECT_TRUE(
      std::equal(second.position.begin(), second.position.end(), sum.position.begin() + 21));
  EXPECT_TRUE(std::equal(second.sh.begin(), second.sh.end(), sum.sh.begin() + 7 * 12));
}

TEST(Append, PadsTheLowerDegreeWithZeros) {
  for (const bool lower_first : {true, false}) {
    const GaussianCloud low = random_cloud(3, 1, 0), high = random_cloud(3, 2, 2);
    GaussianCloud sum = lower_first ? low : high;
    append(sum, GaussianCloud(lower_first ? high : low), "second.ply");
    ASSERT_EQ(sum.sh_degree, 2);
    ASSERT_EQ(sum.sh.size(), 6u * 27);
    const float* padded = sum.sh.data() + (lower_first ? 0 : 3 * 27);
    EXPECT_EQ(padded[0], low.sh[0]);
    for (int k = 3; k < 27; ++k) EXPECT_EQ(padded[k], 0.0f);
  }
}

TEST(Append, AddsTheReports) {
  GaussianCloud first = random_cloud(2, 1), second = random_cloud(2, 2);
  first.report.read = 3;
  first.report.dropped_opacity = 1;
  second.report.read = 2;
  second.report.repaired_sh = 4;
  append(first, std::move(second), "second.ply");
  EXPECT_EQ(first.report.read, 5u);
  EXPECT_EQ(first.report.dropped(), 1u);
  EXPECT_EQ(first.report.repaired(), 4u);
}

TEST(Append, RefusesAnotherOriginByName) {
  GaussianCloud first = random_cloud(2, 1), second = random_cloud(2, 2);
  second.origin = {1024, 0, 0};
  try {
    append(first, std::move(second), "far.ply");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::refused_input);
    EXPECT_NE(std::string(error.what()).find("far.ply"), std::string::npos);
  }
  EXPECT_EQ(first.size(), 2u);
}

}  // namespace
}  // namespace append_test
}  // namespace voyager::test
