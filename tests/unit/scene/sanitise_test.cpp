#include "runtime/scene/sanitise.h"

#include <limits>

#include "tests/support/test_support.h"

namespace voyager::sanitise_test {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(Sanitise, KeepsSoundWordsToTheBit) {
  GaussianCloud cloud = test::random_cloud(50, 1, 2);
  const GaussianCloud before = cloud;
  sanitise(cloud);
  EXPECT_EQ(cloud.position, before.position);
  EXPECT_EQ(cloud.log_scale, before.log_scale);
  EXPECT_EQ(cloud.rotation, before.rotation);
  EXPECT_EQ(cloud.opacity, before.opacity);
  EXPECT_EQ(cloud.sh, before.sh);
  EXPECT_EQ(cloud.report.read, 50u);
  EXPECT_EQ(cloud.report.dropped() + cloud.report.repaired(), 0u);
}

TEST(Sanitise, DropsWhatCannotBeDrawnAndKeepsTheOrderOfTheRest) {
  GaussianCloud cloud = test::random_cloud(8, 2, 1);
  const GaussianCloud before = cloud;
  cloud.position[3 * 0 + 1] = kNan;
  cloud.position[3 * 2] = -1e18f;
  cloud.log_scale[3 * 3 + 2] = kInf;
  cloud.log_scale[3 * 5] = kNan;
  cloud.opacity[6] = kNan;
  cloud.position[3 * 6] = kInf;  // counted once, for its position
  cloud.opacity[7] = kNan;
  sanitise(cloud);
  EXPECT_EQ(cloud.report.read, 8u);
  EXPECT_EQ(cloud.report.dropped_position, 3u);
  EXPECT_EQ(cloud.report.dropped_scale, 2u);
  EXPECT_EQ(cloud.report.dropped_opacity, 1u);
  ASSERT_EQ(cloud.size(), 2u);
  const size_t kept[2] = {1, 4};
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(cloud.opacity[i], before.opacity[kept[i]]);
    for (size_t k = 0; k < 3; ++k)
      EXPECT_EQ(cloud.position[3 * i + k], before.position[3 * kept[i] + k]);
    for (size_t k = 0; k < 3; ++k)
      EXPECT_EQ(cloud.log_scale[3 * i + k], before.log_scale[3 * kept[i] + k]);
    for (size_t k = 0; k < 4; ++k)
      EXPECT_EQ(cloud.rotation[4 * i + k], before.rotation[4 * kept[i] + k]);
    for (size_t k = 0; k < 12; ++k) EXPECT_EQ(cloud.sh[12 * i + k], before.sh[12 * kept[i] + k]);
  }
  EXPECT_EQ(cloud.position.size(), 6u);
  EXPECT_EQ(cloud.sh.size(), 24u);
}

TEST(Sanitise, RepairsAndCountsGaussiansNotValues) {
  GaussianCloud cloud = test::random_cloud(6, 3, 1);
  cloud.log_scale[0] = -100.0f;
  cloud.log_scale[1] = 100.0f;
  for (size_t k = 0; k < 4; ++k) cloud.rotation[4 * 1 + k] = 0.0f;
  cloud.rotation[4 * 2 + 3] = kNan;
  cloud.opacity[3] = kInf;
  cloud.opacity[4] = -kInf;
  cloud.sh[12 * 5] = kNan;
  cloud.sh[12 * 5 + 11] = -kInf;
  sanitise(cloud);
  ASSERT_EQ(cloud.size(), 6u);
  EXPECT_EQ(cloud.report.repaired_scale, 1u);
  EXPECT_EQ(cloud.log_scale[0], kMinLogScale);
  EXPECT_EQ(cloud.log_scale[1], kMaxLogScale);
  EXPECT_EQ(cloud.report.repaired_rotation, 2u);
  for (size_t i : {size_t{1}, size_t{2}}) {
    EXPECT_EQ(cloud.rotation[4 * i], 1.0f);
    for (size_t k = 1; k < 4; ++k) EXPECT_EQ(cloud.rotation[4 * i + k], 0.0f);
  }
  EXPECT_EQ(cloud.report.repaired_opacity, 2u);
  EXPECT_EQ(cloud.opacity[3], kMaxLogit);
  EXPECT_EQ(cloud.opacity[4], -kMaxLogit);
  EXPECT_EQ(cloud.report.repaired_sh, 1u);
  EXPECT_EQ(cloud.sh[12 * 5], 0.0f);
  EXPECT_EQ(cloud.sh[12 * 5 + 11], 0.0f);
  EXPECT_EQ(cloud.report.dropped(), 0u);
}

TEST(Sanitise, AnEmptyCloudStaysEmpty) {
  GaussianCloud cloud;
  sanitise(cloud);
  EXPECT_EQ(cloud.size(), 0u);
  EXPECT_EQ(cloud.report.read, 0u);
}

}  // namespace
}  // namespace voyager::sanitise_test
