#include "runtime/select/references.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace voyager::references_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

CutQuery at(float x, float target = 0.5f) {
  return {{x, 0, 0}, target};
}

TEST(References, AFrameAtTheSamePlaceSharesTheReference) {
  References references;
  references.begin_frame(at(1));
  const uint32_t first = references.current();
  for (int i = 0; i < 1000; ++i) {
    references.begin_frame(at(1));
    ASSERT_EQ(references.current(), first);
    ASSERT_EQ(references.travel()[first].way, 0.0f);
    ASSERT_EQ(references.travel()[first].turn, 0.0f);
  }
  references.begin_frame(at(1, 0.25f));
  EXPECT_NE(references.current(), first);
  references.begin_frame(at(2, 0.25f));
  EXPECT_EQ(references.current(), first + 2);
}

TEST(References, TravelIsNeverLessThanTheWay) {
  References references;
  references.begin_frame({{1, 2, 3}, 0.1f});
  references.begin_frame({{1.5f, 1, 3.25f}, 0.3f});
  const Travel& t = references.travel()[0];
  const double way = std::sqrt(0.25 + 1 + 0.0625);
  const double turn = 1 / double{0.1f} - 1 / double{0.3f};
  EXPECT_GT(double{t.way}, way);
  EXPECT_LT(double{t.way}, way * (1 + 1e-6));
  EXPECT_GT(double{t.turn}, turn);
  EXPECT_LT(double{t.turn}, turn * (1 + 1e-6));
}

TEST(References, TheSmallestStepsCount) {
  References references;
  references.begin_frame({{0, 1e17f, 0}, 0.1f});
  references.begin_frame({{1e-45f, 1e17f, 0}, std::nextafter(0.1f, 1.0f)});
  EXPECT_EQ(references.current(), 1u);
  EXPECT_GT(references.travel()[0].way, 0.0f);
  EXPECT_GT(references.travel()[0].turn, 0.0f);
  references.begin_frame({{1e-45f, 1e17f, 0}, std::numeric_limits<float>::max()});
  references.begin_frame({{1e-45f, 1e17f, 0}, kInfinity});
  EXPECT_GT(references.travel()[2].turn, 0.0f);
}

TEST(References, TheOldestIsForgottenAndSaysHowFarItWas) {
  References references;
  for (uint32_t i = 0; i < kReferences; ++i) {
    references.begin_frame(at(static_cast<float>(i)));
    ASSERT_EQ(references.current(), i);
    ASSERT_EQ(references.retired().way, kInfinity);
  }
  references.begin_frame(at(1000));
  EXPECT_EQ(references.current(), 0u);
  EXPECT_EQ(references.travel()[0].way, kInfinity);
  EXPECT_GE(references.retired().way, 1000.0f);
  EXPECT_LT(references.retired().way, 1000.1f);
  EXPECT_GE(references.travel()[1].way, 999.0f);
  EXPECT_LT(references.travel()[1].way, 999.1f);
  references.begin_frame(at(1001));
  EXPECT_EQ(references.current(), 1u);
  EXPECT_LT(references.travel()[0].way, 1.1f) << "taken over by the frame before";
  EXPECT_EQ(references.travel()[1].way, kInfinity);
  references.begin_frame(at(1001));
  EXPECT_EQ(references.travel()[1].way, 0.0f);
  EXPECT_EQ(references.retired().way, kInfinity);
}

TEST(References, WhatCannotBeSaidIsUnknown) {
  References references;
  references.begin_frame({{0, 0, 0}, 1e-45f});
  references.begin_frame({{0, 0, 0}, 1.0f});
  EXPECT_EQ(references.travel()[0].turn, kInfinity);
  references.clear();
  references.begin_frame({{0, 0, 0}, 1.0f});
  EXPECT_EQ(references.current(), 0u);
  EXPECT_EQ(references.travel()[0].turn, 0.0f);
}

}  // namespace
}  // namespace voyager::references_test
