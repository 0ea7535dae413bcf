// Where inputs that are joined have native pixels of their own, and where one does for all.
#include "runtime/bake/input_levels.h"

#include <cmath>

#include "tests/support/test_support.h"

namespace voyager::input_levels_test {
namespace {

// Of a random cloud `scale` times as large; 0: without Gaussians.
InputScales input(uint32_t end, double scale) {
  InputScales made{end, {}};
  if (scale == 0) return made;
  GaussianCloud cloud = test::random_cloud(500, 6, 0);
  for (float& s : cloud.log_scale) s += static_cast<float>(std::log(scale));
  made.scales.add(cloud);
  return made;
}

double pixel(const InputScales& of) {
  return of.scales.estimate().pixel;
}

TEST(InputLevels, EstimatesThatAreNearAreOneOverAll) {
  const std::vector<InputScales> inputs{input(500, 1), input(1000, 1.3)};
  const JoinedScale joined = joined_scale(inputs);
  EXPECT_TRUE(joined.levels.empty());
  ScaleHistogram all = inputs[0].scales;
  all.add(inputs[1].scales);
  EXPECT_EQ(joined.scale, all.estimate());
  EXPECT_TRUE(levels_of(joined.levels).empty());
  EXPECT_TRUE(joined_scale({}).levels.empty());
}

TEST(InputLevels, EachHasTheLevelOfItsEstimate) {
  const std::vector<InputScales> inputs{input(2, 1), input(2, 0), input(5, 4), input(6, 2)};
  const JoinedScale joined = joined_scale(inputs);
  EXPECT_EQ(joined.scale.pixel, pixel(inputs[2]));
  EXPECT_EQ(joined.scale.source, NativeSource::estimated);
  const std::vector<uint8_t> expected{4, 4, 0, 0, 0, 2};
  EXPECT_EQ(levels_of(joined.levels), expected);
  const uint32_t places[] = {1, 4, 5};
  EXPECT_EQ(levels_of(joined.levels, places), (std::vector<uint8_t>{4, 0, 2}));
}

// One input of few and large Gaussians does not blur the others.
TEST(InputLevels, TheSmallestIsKeptWhereLevelsDoNotReach) {
  const std::vector<InputScales> inputs{input(1, 1), input(2, 1000)};
  const JoinedScale joined = joined_scale(inputs);
  EXPECT_EQ(levels_of(joined.levels), (std::vector<uint8_t>{kFootprintLevels - 1, 0}));
  EXPECT_NEAR(joined.scale.pixel_of(kFootprintLevels - 1) / pixel(inputs[0]), 1, 1e-9);
}

}  // namespace
}  // namespace voyager::input_levels_test
