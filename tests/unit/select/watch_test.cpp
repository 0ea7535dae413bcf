#include "runtime/select/watch.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <limits>
#include <random>

namespace voyager::watch_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(Watch, KeepsTheReferenceAndAnExtentThatIsNotLess) {
  std::mt19937 random(1);
  for (int i = 0; i < 100000; ++i) {
    uint32_t bits = random() & 0x7fffffffu;
    if (bits > 0x7f800000u) bits = 0x7f800000u;
    float extent;
    std::memcpy(&extent, &bits, sizeof extent);
    const uint32_t reference = random() % kReferences;
    const Watch watch = make_watch(1.0f, extent, reference);
    ASSERT_EQ(watch_reference(watch), reference);
    ASSERT_GE(watch_extent(watch), extent);
    if (extent > FLT_MIN && extent < 1e38f) {
      ASSERT_LE(watch_extent(watch), extent * (1 + 0x1p-11f));
    }
  }
  for (const float extent : {0.0f, 1.0f, 0.75f, kInfinity})
    EXPECT_EQ(watch_extent(make_watch(1.0f, extent, 7)), extent);
  EXPECT_EQ(watch_extent(make_watch(1.0f, FLT_MAX, 7)), kInfinity);
  EXPECT_GT(watch_extent(make_watch(1.0f, FLT_TRUE_MIN, 7)), 0.0f);
}

TEST(Watch, IsDueWhereTheWayUsesUpTheSlack) {
  Travel travel[kReferences] = {};
  travel[3] = {0.5f, 0.25f};
  EXPECT_FALSE(due(make_watch(1.01f, 2.0f, 3), travel));
  EXPECT_TRUE(due(make_watch(1.0f, 2.0f, 3), travel));
  EXPECT_FALSE(due(make_watch(0.51f, 0.0f, 3), travel));
  EXPECT_FALSE(due(make_watch(1e-20f, 2.0f, 4), travel)) << "nothing has moved";
  EXPECT_TRUE(due(make_watch(0.0f, 2.0f, 4), travel));
}

TEST(Watch, IsDueWhereSomethingIsNotKnownAndNeverWhereNothingIsDecided) {
  Travel travel[kReferences] = {};
  travel[1] = {kInfinity, kInfinity};
  EXPECT_TRUE(due(make_watch(FLT_MAX, 0.0f, 1), travel));
  EXPECT_TRUE(due(make_watch(FLT_MAX, 1.0f, 1), travel));
  EXPECT_TRUE(due(make_watch(1.0f, kInfinity, 0), travel)) << "∞ · 0";
  EXPECT_FALSE(due(make_watch(kInfinity, 0.0f, 1), travel));
}

TEST(Watch, SlackLeftIsLessThanWhatIsLeft) {
  std::mt19937 random(2);
  const auto uniform = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
  for (int i = 0; i < 100000; ++i) {
    const Watch watch = make_watch(uniform(), uniform(), 0);
    const Travel t{uniform() * watch.slack, uniform() * uniform()};
    const double left =
        double{watch.slack} - (double{t.way} + double{watch_extent(watch)} * double{t.turn});
    if (slack_left(watch, t) > 0.0f) {
      ASSERT_LE(double{slack_left(watch, t)}, left);
    }
    if (left > 0) {
      ASSERT_GE(double{slack_left(watch, t)}, left - 1e-6 * double{watch.slack});
    }
  }
  EXPECT_FALSE(slack_left(make_watch(1.0f, 1.0f, 0), {kInfinity, kInfinity}) > 0.0f);
}

TEST(Watch, TargetSizesHaveAnInverseThatTellsThemApart) {
  EXPECT_EQ(inverse_target_size(0.5f), 2.0);
  EXPECT_EQ(inverse_target_size(kInfinity), 0x1p-128);
  EXPECT_GT(inverse_target_size(FLT_MAX), inverse_target_size(kInfinity));
}

}  // namespace
}  // namespace voyager::watch_test
